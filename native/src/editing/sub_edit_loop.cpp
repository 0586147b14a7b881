// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/sub_edit_loop.hpp"

#include <algorithm>
#include <cmath>

#include "editing/acceptance_search.hpp"
#include "editing/control_interpolation.hpp"
#include "editing/round_loop.hpp"

namespace stiv {

namespace {

constexpr int most_cuts = 256;        // parts of a motion that is too far to be looked at in one piece
constexpr double least_gain = 1e-3;   // relative fall of E that makes another sub-edit worth while
constexpr double largest_turn = 0.3;  // radians a step; the chord of an arc then leaves it by 1.1 % of the radius

void record(SolveReport& report, RoundOutcome& outcome, const Acceptance& acceptance) {
  if (!outcome.events.empty()) {
    report.events = std::move(outcome.events);
    report.patches = outcome.patches;
  }
  if (acceptance.held) report.fraction = std::min(report.fraction, acceptance.fraction);
  report.blocked = !outcome.clear || acceptance.held;
}

/// The goal itself, as if rounds had come to it: of an answer that leads nowhere not even a part may be free, or lower
/// the energy, while some of the straight way is and does.
RoundOutcome straight_way(const Problem& problem, const Aim& aim, PairLimit pair_limit, Execution& execution) {
  RoundOutcome outcome;
  outcome.candidate.controls = problem.stored(aim.controls);
  outcome.candidate.surface = problem.surface_at(outcome.candidate.controls, execution);
  outcome.pair_limit = pair_limit;
  return outcome;
}

/// The displacement of a control along the axes of its weights. A trifle of it is the rounding of turned axes.
Vector3 along_weight_axes(const EditOptions& options, Index control, const Vector3& displacement) {
  constexpr double rounding = 1e-12;
  if (options.weight_axes.empty()) return displacement;
  const Vector3 along = options.weight_axes[static_cast<std::size_t>(control)].transpose() * displacement;
  return (along.array().abs() > rounding * displacement.norm()).select(along, 0);
}

/// Does the goal move controls along axes in which they do not respond? What they hit must give way, which may raise
/// the energy.
bool moves_pinned_controls(const Problem& problem, const Controls& from, const Controls& to) {
  const EditOptions& options = problem.options();
  if (options.weights.size() == 0) return false;
  const Index values = static_cast<Index>(options.weights.size() / from.rows());
  for (Index k = 0; k < from.rows(); ++k) {
    const auto weights = options.weights.segment(values * k, values);
    if (!(weights.array() == 0).any() || from.row(k) == to.row(k)) continue;
    if (values == 1) return true;
    const Vector3 moved = along_weight_axes(options, k, (to.row(k) - from.row(k)).transpose());
    if ((weights.array() == 0 && moved.array() != 0).any()) return true;
  }
  return false;
}

/// The first answer of an edit. Constraints that are kept were linearised at other candidates, and may together lead
/// far away, where the surface folds a lot on the way to the goal: one that raises the energy though nothing pinned
/// pushes is compared with that of Algorithm 1, which keeps none. The better one is taken. More constraints raise it
/// further, so that such rounds are given up early, and taken to their end only if the others stray as well.
RoundOutcome first_answer(Problem& problem, const State& accepted, const Aim& aim, double& part, Execution& execution) {
  const auto energy_of = [&](const RoundOutcome& outcome) { return energy(outcome.candidate.surface, aim.surface); };
  const auto rounds = [&](Projection projection, const StatePredicate& is_diverging = {}) {
    return run_rounds_within_reach(problem, accepted, aim.controls, projection, part, is_diverging, execution);
  };
  if (has_begun_rounds(problem, accepted, aim.controls, Projection::from_last_round))
    return rounds(Projection::from_last_round);
  const bool may_stray =
      problem.options().accumulated_rounds > 0 && !moves_pinned_controls(problem, accepted.controls, aim.controls);
  if (!may_stray) return rounds(Projection::from_goal);
  const double before = energy(accepted.surface, aim.surface);
  const auto strays = [&](const State& state) { return part == 1 && energy(state.surface, aim.surface) > before; };
  RoundOutcome outcome = rounds(Projection::from_goal, strays);
  const bool strayed = outcome.given_up || (outcome.clear && strays(outcome.candidate));
  if (!strayed) return outcome;
  RoundOutcome other = rounds(Projection::from_last_round);
  if (other.clear && !strays(other.candidate)) return other;
  if (outcome.given_up) outcome = rounds(Projection::from_goal);
  return other.clear && energy_of(other) < energy_of(outcome) ? other : outcome;
}

}  // namespace

void solve(Problem& problem, State& accepted, const Aim& aim, SolveReport& report, Execution& execution) {
  const int most = aim.must_improve ? 1 : problem.options().max_sub_edits;  // pulls go on by themselves
  double before = energy(accepted.surface, aim.surface), part = 1;
  for (int sub_edit = 0, cuts = 0; sub_edit < most; ++sub_edit) {
    ++execution.counters.sub_edits;
    RoundOutcome outcome =
        sub_edit == 0 && !aim.must_improve
            ? first_answer(problem, accepted, aim, part, execution)
            : run_rounds_within_reach(problem, accepted, aim.controls, Projection::from_goal, part, {}, execution);
    // A first answer that settled is taken even if E grows: a pinned object may push a larger one out of its way.
    const bool taken_anyway = sub_edit == 0 && outcome.clear && !aim.must_improve;
    const auto agreeable = [&](const State& state) {
      return taken_anyway || energy(state.surface, aim.surface) < before;
    };
    Acceptance acceptance = accept_largest(problem, accepted, outcome, agreeable, execution);
    const bool nothing_to_gain = outcome.clear && aim.must_improve;
    if (acceptance.fraction == 0 && sub_edit == 0 && !nothing_to_gain) {
      const RoundOutcome straight = straight_way(problem, aim, outcome.pair_limit, execution);
      acceptance = accept_largest(problem, accepted, straight, agreeable, execution);
      acceptance.held = true;
    }
    record(report, outcome, acceptance);
    if (acceptance.fraction == 0) return;
    accepted = std::move(acceptance.state);
    execution.note_gain();
    report.path.push_back(accepted.controls);
    const double after = energy(accepted.surface, aim.surface);
    if (part == 1 && !report.blocked) return;
    if (part < 1 && !report.blocked && after < before && cuts < most_cuts) {
      ++cuts;
      --sub_edit;  // settled as far as was looked: no try at the whole goal yet
    } else if (after > (1 - least_gain) * before) {
      break;
    }
    before = after;
  }
  report.blocked = true;  // short of the goal, and not for having settled
}

void solve_in_turns(Problem& problem, State& accepted, const Aim& aim, SolveReport& report, Execution& execution) {
  const std::vector<Index>& rows = problem.rotation_rows();
  const std::vector<Index> turning = problem.deformation().rotation_rows();
  const auto turn = [&] { return largest_rotation(accepted.controls, aim.controls, turning); };
  const int steps = static_cast<int>(std::ceil(turn() / largest_turn));
  for (int step = 1; step < steps; ++step) {
    const double fraction = std::min(1.0, largest_turn / turn());
    const Controls before = accepted.controls;
    const Aim part{interpolate(before, aim.controls, fraction, rows), aim.surface, aim.must_improve};
    solve(problem, accepted, part, report, execution);
    if (accepted.controls == before) return;
  }
  const Controls last = interpolate(accepted.controls, aim.controls, std::min(1.0, largest_turn / turn()), rows);
  solve(problem, accepted, {last, aim.surface, aim.must_improve}, report, execution);
}

}  // namespace stiv
