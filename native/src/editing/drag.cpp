// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/drag.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "editing/control_interpolation.hpp"
#include "editing/feasible_state.hpp"
#include "editing/sub_edit_loop.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr int max_pulls_of_drag = 12;
constexpr double shortest_stride = 0.25;           // in pull distances
constexpr double least_energy_drop_rate = 1.5e-3;  // relative, for each round of a pull; below it the pull is poor
constexpr double growing_rate = 1.5;               // of the rate of the pull before

/// The accepted controls, plus the motion of the goal since it was last followed; the goal itself if it was reached
/// then.
Controls incremented(const EditCall& call, const Controls& followed, const Controls& goal) {
  if (call.accepted.controls == call.context.stored(followed)) return goal;
  return moved_alike(call.accepted.controls, followed, goal, call.context.rotation_rows());
}

void pull(EditCall& call, const Aim& aim, double distance) {
  const double missing = std::sqrt((aim.surface - call.accepted.surface).rowwise().squaredNorm().maxCoeff());
  const double fraction = missing > distance ? distance / missing : 1;
  const Controls goal = interpolate(call.accepted.controls, aim.controls, fraction, call.context.rotation_rows());
  if (call.context.stored(goal) == call.accepted.controls) return;
  run_sub_edits_by_steps(call, {goal, aim.surface, true});
}

/// Pulls. Returns the relative drop of the energy for each round that this takes.
double energy_drop_rate(EditCall& call, const Aim& aim, double distance) {
  const Counters& counters = call.execution.counters;
  const std::int64_t rounds_before = counters.rounds;
  const double before = energy(call.accepted.surface, aim.surface);
  pull(call, aim, distance);
  const double after = energy(call.accepted.surface, aim.surface);
  const auto rounds = static_cast<double>(std::max<std::int64_t>(counters.rounds - rounds_before, 1));
  return before > 0 ? (1 - after / before) / rounds : 0;
}

}  // namespace

double longest_displacement(const Positions& from, const Positions& to) {
  return (to - from).rowwise().norm().maxCoeff();
}

// A stride with contacts that took several calls is halved for the next one; any other is doubled. Without contacts, a
// shorter stride takes as long.
void follow_goal(EditCall& call, const Aim& aim, DragProgress& drag) {
  for (bool arrives = false; !arrives;) {
    const double way = longest_displacement(drag.followed.surface, aim.surface);
    arrives = way <= drag.stride || !call.execution.has_time_budget();
    State next{aim.controls, aim.surface};
    if (!arrives) {
      const Controls stride =
          interpolate(drag.followed.controls, aim.controls, drag.stride / way, call.context.rotation_rows());
      std::optional<State> reached = feasible_state(call.context, stride, call.execution);
      arrives = !reached;  // no surface on the way: at once to the goal
      if (reached) next = std::move(*reached);
    }
    const std::size_t accepted_before = call.report.path.size();
    const std::int64_t rounds_before = call.execution.counters.rounds;
    try {
      const Controls increment = incremented(call, drag.followed.controls, next.controls);
      if (call.context.stored(increment) != call.accepted.controls)
        run_sub_edits_by_steps(call, {increment, aim.surface, false});
    } catch (const Interrupted&) {
      if (call.report.path.size() > accepted_before)
        drag.followed = std::move(next);  // else the next call begins with the rest of the stride
      drag.stride_took_several_calls |= call.execution.counters.rounds > rounds_before;
      throw;
    }
    drag.followed = std::move(next);
    drag.stride = drag.stride_took_several_calls
                      ? std::max(std::min(drag.stride, way) / 2, shortest_stride * call.context.pull_distance())
                      : 2 * drag.stride;
    drag.stride_took_several_calls = false;
  }
}

PullLimits pull_limits_of_drag(const EditContext& context, const DragProgress& drag, const Aim& aim) {
  const double increment = longest_displacement(drag.followed.surface, aim.surface);
  const double pulls = std::min<double>(max_pulls_of_drag, 1 + std::ceil(increment / context.pull_distance()));
  return {.distance = context.pull_distance(), .pulls = static_cast<int>(pulls)};
}

void pull_until_settled(EditCall& call, const Aim& aim, const PullLimits& limits) {
  double rate_before = std::numeric_limits<double>::infinity();
  int poor = 0;
  for (int k = 0; k < limits.pulls && poor < limits.poor_pulls; ++k) {
    const double rate = energy_drop_rate(call, aim, limits.distance);
    if (!(rate > 0)) return;
    poor = rate >= least_energy_drop_rate || rate > growing_rate * rate_before ? 0 : poor + 1;
    rate_before = rate;
  }
}

void leap(EditCall& call, const Aim& aim, DragProgress& drag) {
  const EditContext& context = call.context;
  const bool is_far = longest_displacement(call.accepted.surface, aim.surface) > context.far_distance();
  if (!is_far || context.pull_distance() == 0 || drag.leapt_from == call.accepted.controls) return;
  const bool was_blocked = call.report.blocked;
  const Controls from = call.accepted.controls;
  drag.is_leaping = true;
  pull(call, aim, std::numeric_limits<double>::infinity());
  drag.is_leaping = false;
  if (call.accepted.controls == from) drag.leapt_from = from;
  call.report.blocked = was_blocked && call.report.blocked;
}

}  // namespace stiv
