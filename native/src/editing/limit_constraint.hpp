// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <optional>
#include <utility>

#include "response/sparse_fields.hpp"
#include "stiv/response/resolver.hpp"

namespace stiv {

/// The constraint direction . p >= bound on a single control. Nothing if the control does not respond along it.
inline std::optional<ControlConstraint> limit_constraint(Index control, const Vector3& direction, double bound,
                                                         Index name, const Metric& metric, const Controls& metric_at) {
  ControlConstraint constraint{{{control}, {direction}}, {}, bound, name};
  constraint.step = metric.apply_inverse(metric_at, constraint.row);
  const double squared_length = dot(constraint.row, constraint.step);
  if (!(squared_length > 0)) return std::nullopt;
  const double normalise = 1 / std::sqrt(squared_length);
  scale(constraint.row, normalise);
  scale(constraint.step, normalise);
  constraint.bound *= normalise;
  return constraint;
}

}  // namespace stiv
