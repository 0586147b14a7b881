// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/acceptance_search.hpp"

#include "editing/control_interpolation.hpp"
#include "editing/feasible_state.hpp"

namespace stiv {

namespace {

constexpr int max_attempts = 24;  // 2^-24 of a step is the precision of float32
constexpr double before_contact = 0.9;

/// Nothing if the deformation has no surface there.
std::optional<State> state_at_fraction(const EditCall& call, const State& candidate, double fraction) {
  const Controls controls = call.context.stored(
      interpolate(call.accepted.controls, candidate.controls, fraction, call.context.rotation_rows()));
  return feasible_state(call.context, controls, call.execution);
}

}  // namespace

Acceptance accept_largest_fraction(EditCall& call, RoundOutcome& outcome, const StatePredicate& is_agreeable) {
  const Positions& from = call.accepted.surface;
  Acceptance acceptance;
  double fraction = call.context.limits().fraction_of_longest_step(call.accepted.controls, outcome.candidate.controls);
  acceptance.is_part = fraction < 1;
  for (int attempt = 0; attempt < max_attempts; ++attempt) {
    call.execution.check();
    std::optional<State> part;
    if (fraction < 1) part = state_at_fraction(call, outcome.candidate, fraction);
    State* const found = fraction == 1 ? &outcome.candidate : part ? &*part : nullptr;
    if (found && found->controls == call.accepted.controls) break;
    const bool settled = fraction == 1 && outcome.clear;
    if (!found || !is_agreeable(*found)) {
      if (settled) break;
      fraction *= 0.5;
      continue;
    }
    State& state = *found;
    ++call.execution.counters.acceptance_tries;
    const bool path_is_clear = settled && call.queries.rounds_prove_clearance();
    const std::optional<double> contact =
        path_is_clear ? never : call.queries.earliest_time(from, state.surface, outcome.pair_limit, call.execution);
    const double time = contact.value_or(0);  // too far to test: half of it
    double allowed = time > 0 && time <= 1 ? before_contact * time : 0.5;
    if (time == never) allowed = call.queries.free_fraction(from, state.surface, call.execution);
    if (allowed == 1) {
      acceptance.state = std::move(state);
      acceptance.fraction = fraction;
      break;
    }
    acceptance.truncated = true;
    if (allowed == 0) break;
    fraction *= allowed;
  }
  return acceptance;
}

}  // namespace stiv
