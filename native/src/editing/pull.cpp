// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/pull.hpp"

#include <algorithm>
#include <cmath>

#include "editing/control_interpolation.hpp"

namespace stiv {

namespace {

/// Relative fall of E for each round of a pull that makes another one worth while.
constexpr double least_gain_a_round = 1.5e-3;

bool was_worth_while(double before, double after, std::int64_t rounds) {
  return after < (1 - least_gain_a_round * static_cast<double>(std::max<std::int64_t>(rounds, 1))) * before;
}

}  // namespace

void pull(Problem& problem, State& accepted, const Aim& aim, double limit, SolveReport& report, Execution& execution) {
  const double missing = std::sqrt((aim.surface - accepted.surface).rowwise().squaredNorm().maxCoeff());
  const double fraction = missing > limit ? limit / missing : 1;
  const Controls part = interpolate(accepted.controls, aim.controls, fraction, problem.rotation_rows());
  if (problem.stored(part) == accepted.controls) return;
  solve_in_turns(problem, accepted, {part, aim.surface, true}, report, execution);
}

void pull_until_settled(Problem& problem, State& accepted, const Aim& aim, const PullLimits& limits,
                        SolveReport& report, Execution& execution) {
  for (int k = 0; k < limits.pulls && execution.counters.rounds < limits.rounds; ++k) {
    const std::int64_t rounds = execution.counters.rounds;
    const double before = energy(accepted.surface, aim.surface);
    pull(problem, accepted, aim, limits.distance, report, execution);
    const double after = energy(accepted.surface, aim.surface);
    if (!was_worth_while(before, after, execution.counters.rounds - rounds)) return;
  }
}

}  // namespace stiv
