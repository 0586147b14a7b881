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
constexpr double least_detour_gain = 0.1;          // relative drop of the energy
constexpr double missing_growth = 2;               // of the way to the goal, until a drag tries a detour again
constexpr double least_leap_gain = 0.02;           // relative drop of the energy; below it the leap gained little
constexpr double missing_growth_to_leap = 1.25;    // of the way to the goal, until a drag leaps again

/// The accepted controls, plus the motion of the goal since it was last followed; the goal itself if it was reached
/// then.
Controls incremented(const EditCall& call, const Controls& followed, const Controls& goal) {
  if (call.accepted.controls == call.context.stored(followed)) return goal;
  return moved_alike(call.accepted.controls, followed, goal, call.context.rotation_rows());
}

/// Controls on the way from `from`, close to the accepted ones, to the goal: as far as a pull of this distance goes.
Controls pulled(const EditCall& call, const Controls& from, const Aim& aim, double distance) {
  const double missing = std::sqrt((aim.surface - call.accepted.surface).rowwise().squaredNorm().maxCoeff());
  const double fraction = missing > distance ? distance / missing : 1;
  return interpolate(from, aim.controls, fraction, call.context.rotation_rows());
}

/// The controls after a stride, and after a part of a pull if the call hands over: it may then end before another
/// sub-edit could pull. Toward the goal of the stride, since later strides add the rest. Without a large body: to
/// search further costs it more.
Controls incremented_and_pulled(const EditCall& call, const DragProgress& drag, const State& next) {
  Controls increment = incremented(call, drag.followed.controls, next.controls);
  const bool moves = call.context.stored(increment) != call.accepted.controls;
  if (!moves || !call.hand_over || call.context.has_large_body()) return increment;
  const Aim stride{next.controls, next.surface, false};
  return pulled(call, increment, stride, drag.reach * call.context.pull_distance());
}

void pull(EditCall& call, const Aim& aim, double distance) {
  const Controls goal = pulled(call, call.accepted.controls, aim, distance);
  if (call.context.stored(goal) == call.accepted.controls) return;
  run_sub_edits_by_steps(call, {goal, aim.surface, true});
}

/// Pulls. Returns the relative drop of the energy for each round that this takes.
double energy_drop_rate(EditCall& call, const Aim& aim, double distance) {
  const Counters& counters = call.execution.counters;
  const std::int64_t rounds_before = counters.rounds;
  const double before = call.context.energy(call.accepted.surface, aim.surface);
  pull(call, aim, distance);
  const double after = call.context.energy(call.accepted.surface, aim.surface);
  const auto rounds = static_cast<double>(std::max<std::int64_t>(counters.rounds - rounds_before, 1));
  return before > 0 ? (1 - after / before) / rounds : 0;
}

bool is_far(const EditCall& call, const Aim& aim) {
  return call.context.longest_displacement(call.accepted.surface, aim.surface) > call.context.far_distance();
}

/// The part of a displacement along which a control responds.
Vector3 free_part(const EditOptions& options, Index control, Index controls, const Vector3& displacement) {
  if (options.weights.size() == 0) return displacement;
  const Index values = static_cast<Index>(options.weights.size()) / controls;
  if (values == 1) return options.weights[control] > 0 ? displacement : Vector3(Vector3::Zero());
  const bool has_axes = !options.weight_axes.empty();
  const Eigen::Matrix3d axes =
      has_axes ? options.weight_axes[at(control)] : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const Vector3 along = axes.transpose() * displacement;
  return axes * Vector3((options.weights.segment<3>(3 * control).array() > 0).select(along, 0));
}

/// The accepted controls, with the points that the goal moves displaced as far as they respond.
Controls displaced(const EditCall& call, const Controls& goal, const Vector3& offset) {
  Controls controls = call.accepted.controls;
  const std::vector<Index> turning = call.context.deformation().rotation_rows();
  const auto count = static_cast<Index>(controls.rows());
  for (Index k = 0; k < count; ++k) {
    const bool turns = std::find(turning.begin(), turning.end(), k) != turning.end();
    if (!turns && controls.row(k) != goal.row(k))
      controls.row(k) += free_part(call.context.options(), k, count, offset).transpose();
  }
  return call.context.limits().nearest(controls);
}

/// Goes aside and leaps. If the energy is not clearly lower than before, returns to the start and false.
bool passes_aside(EditCall& call, const Aim& aim, const Vector3& offset) {
  const Controls goal = displaced(call, aim.controls, offset);
  std::optional<State> aside = feasible_state(call.context, goal, call.execution);
  if (!aside || goal == call.accepted.controls) return false;
  const State from = call.accepted;
  const std::size_t steps = call.report.path.size();
  run_sub_edits(call, {goal, aside->surface, false});
  pull(call, aim, std::numeric_limits<double>::infinity());
  const double before = call.context.energy(from.surface, aim.surface),
               after = call.context.energy(call.accepted.surface, aim.surface);
  if (after < (1 - least_detour_gain) * before) return true;
  call.accepted = from;
  call.report.path.resize(steps);
  return false;
}

}  // namespace

// A stride with contacts that took several calls, or was handed over late, is halved for the next one; any other is
// doubled. Without contacts, a shorter stride takes as long.
void follow_goal(EditCall& call, const Aim& aim, DragProgress& drag) {
  const double shortest = shortest_stride * call.context.pull_distance();
  for (bool arrives = false; !arrives;) {
    const double way = call.context.longest_displacement(drag.followed.surface, aim.surface);
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
      const Controls increment = incremented_and_pulled(call, drag, next);
      if (call.context.stored(increment) != call.accepted.controls)
        run_sub_edits_by_steps(call, {increment, aim.surface, false});
      drag.adapt_reach(call);
    } catch (const Interrupted&) {
      const bool has_accepted = call.report.path.size() > accepted_before;
      drag.adapt_reach(call);
      if (has_accepted) drag.followed = std::move(next);  // else the next call begins with the rest of the stride
      const bool is_long = !has_accepted || call.is_late();
      drag.stride_took_too_long |= is_long && call.execution.counters.rounds > rounds_before;
      if (has_accepted && call.is_to_hand_over() && drag.stride_took_too_long) drag.shorten_stride(way, shortest);
      throw;
    }
    drag.followed = std::move(next);
    if (drag.stride_took_too_long)
      drag.shorten_stride(way, shortest);
    else
      drag.stride *= 2;
  }
}

int poor_pulls_before_end(const Execution& execution) { return execution.has_time_budget() ? 1 : 2; }

PullLimits pull_limits_of_drag(const EditContext& context, const DragProgress& drag, const Aim& aim,
                               const Execution& execution) {
  const double increment = context.longest_displacement(drag.followed.surface, aim.surface);
  const int to_retreat =
      static_cast<int>(std::min<double>(max_pulls_of_drag, 1 + std::ceil(increment / context.pull_distance())));
  if (context.has_large_body()) return {to_retreat * context.pull_distance(), 1, 1};
  const int pulls = execution.has_time_budget() ? to_retreat : max_pulls_of_drag;
  return {context.pull_distance(), pulls, poor_pulls_before_end(execution)};
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
  if (!is_far(call, aim) || context.pull_distance() == 0 || drag.leapt_from == call.accepted.controls) return;
  const bool was_blocked = call.report.blocked;
  const Controls from = call.accepted.controls;
  drag.is_leaping = true;
  pull(call, aim, std::numeric_limits<double>::infinity());
  drag.is_leaping = false;
  if (call.accepted.controls == from) drag.leapt_from = from;
  call.report.blocked = was_blocked && call.report.blocked;
}

void pull_and_leap(EditCall& call, const Aim& aim, DragProgress& drag, PullLimits limits) {
  const bool is_rigid = !call.context.deformation().rotation_rows().empty();
  const auto leap_again = [&] {
    const double missing = call.context.longest_displacement(call.accepted.surface, aim.surface);
    if (!is_far(call, aim) || missing < missing_growth_to_leap * drag.missing_at_leap) return;
    const double before = call.context.energy(call.accepted.surface, aim.surface);
    leap(call, aim, drag);
    const double after = call.context.energy(call.accepted.surface, aim.surface);
    drag.missing_at_leap = !is_rigid && after > (1 - least_leap_gain) * before ? missing : 0;
    if (after < before) limits.poor_pulls = 1;
  };
  const bool leaps_first = !is_rigid && !call.execution.has_time_budget();
  if (leaps_first) leap_again();
  pull_until_settled(call, aim, limits);
  if (!leaps_first) leap_again();
}

bool detour(EditCall& call, const Aim& aim) {
  const bool is_one_body = call.context.deformation().rotation_rows().size() == 1;
  if (!is_one_body || !is_far(call, aim) || call.execution.has_time_budget()) return false;
  const EditReport report = call.report;
  const Vector3 way = (aim.surface - call.accepted.surface).colwise().sum().transpose().normalized();
  const Vector3 across = way.unitOrthogonal(), up = way.cross(across);
  for (const double distance : {2 * call.context.far_distance(), 4 * call.context.far_distance()})
    for (const Vector3& direction : {across, up, Vector3(-across), Vector3(-up)})
      if (passes_aside(call, aim, distance * direction)) return true;
  call.report = report;
  return false;
}

bool detour_of_drag(EditCall& call, const Aim& aim, DragProgress& drag) {
  if (call.execution.has_time_budget()) return false;
  const double missing = call.context.longest_displacement(call.accepted.surface, aim.surface);
  if (!(missing > missing_growth * drag.missing_at_detour)) return false;
  const bool passes = detour(call, aim);
  drag.missing_at_detour = passes || !is_far(call, aim) ? 0 : missing;
  return passes;
}

}  // namespace stiv
