// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/sub_goals.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "editing/control_interpolation.hpp"
#include "editing/drag.hpp"
#include "editing/feasible_state.hpp"
#include "editing/sub_edit_loop.hpp"

namespace stiv {

namespace {

constexpr int max_sub_goals = 64;
constexpr double poor_gain = 0.01;  // of the distance between two sub-goals

int sub_goal_count(const EditCall& call, const Aim& aim) {
  if (call.execution.has_time_budget()) return 1;
  const double distance = call.context.longest_displacement(call.accepted.surface, aim.surface);
  return static_cast<int>(std::clamp<double>(std::ceil(distance / call.context.far_distance()), 1, max_sub_goals));
}

}  // namespace

void approach_by_sub_goals(EditCall& call, const Aim& aim) {
  const Controls start = call.accepted.controls;
  const std::vector<Index>& rows = call.context.rotation_rows();
  const int count = sub_goal_count(call, aim);
  const auto distance = [&] { return std::sqrt(call.context.energy(call.accepted.surface, aim.surface)); };
  const double least_gain = poor_gain * distance() / count;
  for (int k = 1, poor = 0; k < count && poor < 2; ++k) {
    const Controls goal = interpolate(start, aim.controls, static_cast<double>(k) / count, rows);
    const double before = distance();
    if (std::optional<State> sub_goal = feasible_state(call.context, goal, call.execution))
      run_sub_edits_by_steps(call, {goal, sub_goal->surface, aim.must_improve});
    poor = before - distance() < least_gain ? poor + 1 : 0;
  }
  run_sub_edits_by_steps(call, aim);
}

void return_to_best(EditCall& call, const Aim& aim) {
  std::vector<Controls>& path = call.report.path;
  double least = call.context.energy(call.accepted.surface, aim.surface);
  std::size_t best = path.size();
  for (std::size_t k = path.size(); k-- > 1;) {
    State state{path[k - 1], call.context.surface_at(path[k - 1], call.execution)};
    const double value = call.context.energy(state.surface, aim.surface);
    if (!(value < least)) continue;
    least = value;
    best = k;
    call.accepted = std::move(state);
  }
  path.resize(best);
}

}  // namespace stiv
