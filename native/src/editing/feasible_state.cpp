// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/feasible_state.hpp"

#include <utility>

#include "editing/control_interpolation.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr int bisections = 8;

}  // namespace

std::optional<State> feasible_state(const EditContext& context, const Controls& controls, Execution& execution) {
  try {
    return State{controls, context.surface_at(controls, execution)};
  } catch (const InfeasibleError&) {
    ++execution.counters.infeasible;
    return std::nullopt;
  }
}

State last_feasible(const EditContext& context, const State& from, const Controls& to, Execution& execution) {
  if (std::optional<State> end = feasible_state(context, to, execution)) return std::move(*end);
  State last = from;
  double low = 0, high = 1;
  for (int k = 0; k < bisections; ++k) {
    const double middle = (low + high) / 2;
    std::optional<State> state =
        feasible_state(context, interpolate(from.controls, to, middle, context.rotation_rows()), execution);
    (state ? low : high) = middle;
    if (state) last = std::move(*state);
  }
  return last;
}

}  // namespace stiv
