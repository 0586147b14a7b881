// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/observed/stored_evaluation.hpp"

#include <string>
#include <utility>

#include "deformation/checks.hpp"
#include "stiv/error.hpp"

namespace stiv {

StoredEvaluation::StoredEvaluation(Evaluation evaluate, Index vertex_count)
    : evaluate_(std::move(evaluate)), vertex_count_(vertex_count) {}

Positions StoredEvaluation::surface(const Controls& p, const Execution& execution) const {
  std::optional<Value> known = stored(p);
  if (!known) known = evaluated(p, execution);
  if (!known->surface) throw InfeasibleError("evaluate has no surface at these controls");
  return std::move(*known->surface);
}

std::optional<StoredEvaluation::Value> StoredEvaluation::stored(const Controls& p) const {
  const std::lock_guard lock(mutex_);
  return last_ && last_->controls == p ? last_ : std::nullopt;
}

StoredEvaluation::Value StoredEvaluation::evaluated(const Controls& p, const Execution& execution) const {
  execution.check();
  Value value{p, {}};
  execution.call_owner([&] {
    const std::lock_guard one_at_a_time(calling_);
    value.surface = evaluate_(p);
  });
  if (value.surface) {
    if (value.surface->rows() != vertex_count_)
      throw InputError("evaluate returned " + std::to_string(value.surface->rows()) + " vertices, expected " +
                       std::to_string(vertex_count_) + "; return nothing if the topology differs");
    check_finite(*value.surface, "evaluate, vertex");
  }
  const std::lock_guard lock(mutex_);
  last_ = value;
  return value;
}

}  // namespace stiv
