// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/acceptance_search.hpp"

#include "editing/control_interpolation.hpp"

namespace stiv {

namespace {

constexpr int most_tries = 24;  // 2^-24 of a step is the precision of what is stored
constexpr double before_contact = 0.9;

State state_at_fraction(const Problem& problem, const State& accepted, const State& candidate, double fraction,
                        Execution& execution) {
  if (fraction == 1) return candidate;
  State state;
  state.controls =
      problem.stored(interpolate(accepted.controls, candidate.controls, fraction, problem.rotation_rows()));
  state.surface = problem.surface_at(state.controls, execution);
  return state;
}

}  // namespace

Acceptance accept_largest(Problem& problem, const State& accepted, const RoundOutcome& outcome,
                          const std::function<bool(const State&)>& agreeable, Execution& execution) {
  Acceptance acceptance;
  double fraction = 1;
  for (int attempt = 0; attempt < most_tries; ++attempt) {
    execution.check();
    State state = state_at_fraction(problem, accepted, outcome.candidate, fraction, execution);
    if (state.controls == accepted.controls) break;
    const bool settled = fraction == 1 && outcome.clear, path_known = settled && problem.rounds_prove_path();
    if (!agreeable(state)) {
      if (settled) break;
      fraction *= 0.5;
      continue;
    }
    ++execution.counters.acceptance_tries;
    const std::optional<double> contact =
        path_known ? never : problem.earliest_time(accepted.surface, state.surface, outcome.pair_limit, execution);
    const double time = contact.value_or(0);  // too far to be looked at: half of it
    if (time == never && problem.is_free(accepted.surface, state.surface, execution)) {
      acceptance.state = std::move(state);
      acceptance.fraction = fraction;
      break;
    }
    acceptance.held = true;
    fraction *= time > 0 && time <= 1 ? before_contact * time : 0.5;
  }
  return acceptance;
}

}  // namespace stiv
