// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/pull.hpp"

#include <algorithm>
#include <cmath>

#include "stiv/editing/goal.hpp"

namespace stiv {

namespace {

constexpr double least_gain = 1e-2;  // relative fall of E that makes another pull worth while

}  // namespace

void pull(Problem& problem, State& accepted, const Aim& aim, double limit, SolveReport& report, Execution& execution) {
  const double missing = std::sqrt((aim.surface - accepted.surface).rowwise().squaredNorm().maxCoeff());
  const double fraction = missing > limit ? limit / missing : 1;
  const Controls part = interpolate(accepted.controls, aim.controls, fraction, problem.rotation_rows());
  if (problem.stored(part) == accepted.controls) return;
  solve_in_turns(problem, accepted, {part, aim.surface, true}, report, execution);
}

void pull_until_settled(Problem& problem, State& accepted, const Aim& aim, double limit, int most, SolveReport& report,
                        Execution& execution) {
  for (int k = 0; k < most; ++k) {
    const double before = energy(accepted.surface, aim.surface);
    pull(problem, accepted, aim, limit, report, execution);
    const double after = energy(accepted.surface, aim.surface);
    if (report.blocked || !(after < (1 - least_gain) * before)) return;
  }
}

}  // namespace stiv
