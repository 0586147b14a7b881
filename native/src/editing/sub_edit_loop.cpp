// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/sub_edit_loop.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "editing/acceptance_search.hpp"
#include "editing/control_interpolation.hpp"
#include "editing/feasible_state.hpp"
#include "editing/round_loop.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr int max_cuts = 256;               // fractions of a motion that is too large for one search
constexpr double least_energy_drop = 1e-3;  // relative; below it no further sub-edit
constexpr double largest_growth = 16;       // of the energy to the goal of a sub-edit: four times the distance
constexpr double largest_rise = 1.1;        // of the energy, in a solution that is shown at once
constexpr int few_rounds = 3;               // of Algorithm 1; then accumulated constraints are tried again
constexpr double largest_turn = 0.3;        // radians a step; its chord leaves the arc by 1.1 % of the radius

/// The goal itself as a candidate, used if no fraction of the step to the first solution is accepted. Without a surface
/// there, the accepted state.
RoundOutcome goal_as_outcome(const EditCall& call, const Aim& aim, PairLimit pair_limit) {
  RoundOutcome outcome;
  outcome.candidate =
      feasible_state(call.context, call.context.stored(aim.controls), call.execution).value_or(call.accepted);
  outcome.pair_limit = pair_limit;
  return outcome;
}

/// The displacement of a control along its weight axes. Components of the size of rounding are 0.
Vector3 along_weight_axes(const EditOptions& options, Index control, const Vector3& displacement) {
  constexpr double rounding = 1e-12;
  if (options.weight_axes.empty()) return displacement;
  const Vector3 along = options.weight_axes[control].transpose() * displacement;
  return (along.array().abs() > rounding * displacement.norm()).select(along, 0);
}

class SubEditLoop {
 public:
  SubEditLoop(EditCall& call, const Aim& aim)
      : call_(call), aim_(aim), energy_before_(call_.context.energy(call.accepted.surface, aim.surface)) {}

  void run();

 private:
  double energy_of(const State& state) const;
  RoundOutcome rounds(Projection projection, const StatePredicate& is_diverging = {});
  bool overshoots(const State& state) const { return fraction_ == 1 && energy_of(state) > energy_before_; }
  /// Whether a drag that is to hand over takes a solution without comparing it with another one.
  bool can_be_shown(const RoundOutcome& outcome) const {
    return outcome.clear && energy_of(outcome.candidate) <= largest_rise * energy_before_;
  }
  RoundOutcome first_answer();
  RoundOutcome better_of(RoundOutcome accumulated, RoundOutcome other);
  std::optional<RoundOutcome> answer_in_better_way();
  bool diverges(const State& state) const;
  Acceptance accept(RoundOutcome& outcome, bool is_first);
  void report(RoundOutcome& outcome, const Acceptance& acceptance);

  EditCall& call_;
  const Aim& aim_;
  double energy_before_;            ///< of the accepted state, before the current sub-edit
  double fraction_ = 1;             ///< of the way to the goal, within reach of one search
  mutable Controls measured_;       ///< of the last energy
  mutable double last_energy_ = 0;  ///< of these controls
};

/// A candidate is measured as a solution, before and after its acceptance; its surface depends on its controls alone.
double SubEditLoop::energy_of(const State& state) const {
  if (measured_.rows() != state.controls.rows() || measured_ != state.controls) {
    last_energy_ = call_.context.energy(state.surface, aim_.surface);
    measured_ = state.controls;
  }
  return last_energy_;
}

RoundOutcome SubEditLoop::rounds(Projection projection, const StatePredicate& is_diverging) {
  const FirstSearch first = aim_.must_improve ? FirstSearch::near_start : FirstSearch::whole_step;
  return run_rounds_within_reach(call_, aim_.controls, projection, first, fraction_, is_diverging);
}

/// The first solution of an edit. Accumulated constraints were linearised at different candidates and may overshoot
/// together. If the energy grows though no pinned control pushes, Algorithm 1 is run as well, and the better solution
/// is used. Accumulating only raises the energy further, so diverging rounds are given up early, and completed only if
/// Algorithm 1 overshoots too. (mathematics.md, "Guarantee")
RoundOutcome SubEditLoop::first_answer() {
  const Controls& from = call_.accepted.controls;
  if (call_.progress && call_.progress->belongs_to(from, aim_.controls, Projection::from_last_round))
    return rounds(Projection::from_last_round);
  const EditOptions& options = call_.context.options();
  if (options.accumulated_rounds == 0 || moves_pinned_controls(options, from, aim_.controls))
    return rounds(Projection::from_goal);
  if (std::optional<RoundOutcome> again = answer_in_better_way()) return std::move(*again);
  const auto has_overshot = [&](const State& state) { return overshoots(state); };
  RoundOutcome accumulated = rounds(Projection::from_goal, has_overshot);
  const bool overshot = accumulated.given_up || (accumulated.clear && overshoots(accumulated.candidate));
  // Without a response, Algorithm 1 has the same solution.
  const bool has_responded = call_.progress->round > 0 || call_.progress->begins_with_contacts;
  if (!overshot || !has_responded) return accumulated;
  return better_of(std::move(accumulated), rounds(Projection::from_last_round));
}

/// The better solution, after accumulated constraints overshot.
RoundOutcome SubEditLoop::better_of(RoundOutcome accumulated, RoundOutcome other) {
  const bool suffices = call_.overshoot != nullptr && accumulated.given_up && can_be_shown(other);
  bool is_better = suffices || (other.clear && !overshoots(other.candidate));
  if (!is_better) {
    if (accumulated.given_up) accumulated = rounds(Projection::from_goal);
    is_better = other.clear && energy_of(other.candidate) < energy_of(accumulated.candidate);
  }
  if (call_.overshoot != nullptr)
    call_.overshoot->better = is_better ? Projection::from_last_round : Projection::from_goal;
  return std::move(is_better ? other : accumulated);
}

/// Solves in the way that was better when constraints last overshot in this drag. Nothing if they did not, or if both
/// ways must be compared again.
std::optional<RoundOutcome> SubEditLoop::answer_in_better_way() {
  if (call_.overshoot == nullptr || !call_.overshoot->better) return std::nullopt;
  const Projection way = *call_.overshoot->better;
  RoundOutcome outcome = rounds(way);
  const bool is_shown = can_be_shown(outcome);
  const bool is_easy = way == Projection::from_goal || call_.progress->round < few_rounds;
  if (!is_shown || (is_easy && !overshoots(outcome.candidate))) call_.overshoot->better.reset();
  return is_shown ? std::optional(std::move(outcome)) : std::nullopt;
}

/// Is a state so far from the goal of the sub-edit that it cannot be a projection of it? Nearly linear constraints,
/// which the accepted state satisfies, never lead further away than that state is.
bool SubEditLoop::diverges(const State& state) const {
  if (moves_pinned_controls(call_.context.options(), call_.accepted.controls, aim_.controls)) return false;
  const std::optional<State> goal = feasible_state(call_.context, aim_.controls, call_.execution);
  return goal && call_.context.energy(state.surface, goal->surface) >
                     largest_growth * call_.context.energy(call_.accepted.surface, goal->surface);
}

/// Accepts a fraction of the step to the outcome. If no fraction of the first step is accepted, tries the straight step
/// to the goal.
Acceptance SubEditLoop::accept(RoundOutcome& outcome, bool is_first) {
  // A first solution that settled is accepted even if the energy grows: a pinned object may push a larger one aside.
  const bool may_raise_energy = is_first && outcome.clear && !aim_.must_improve;
  const auto is_agreeable = [&](const State& state) {
    return energy_of(state) < energy_before_ || (may_raise_energy && !diverges(state));
  };
  Acceptance acceptance = accept_largest_fraction(call_, outcome, is_agreeable);
  const bool cannot_improve = outcome.clear && aim_.must_improve;
  if (acceptance.fraction > 0 || !is_first || cannot_improve) return acceptance;
  RoundOutcome goal = goal_as_outcome(call_, aim_, outcome.pair_limit);
  acceptance = accept_largest_fraction(call_, goal, is_agreeable);
  acceptance.truncated = true;
  return acceptance;
}

void SubEditLoop::report(RoundOutcome& outcome, const Acceptance& acceptance) {
  EditReport& report = call_.report;
  if (!outcome.events.empty()) {
    report.events = std::move(outcome.events);
    report.patches = outcome.patches;
  }
  if (acceptance.truncated) report.fraction = std::min(report.fraction, acceptance.fraction);
  report.blocked = !outcome.clear || acceptance.truncated || outcome.is_cut;
}

void SubEditLoop::run() {
  EditReport& edit = call_.report;
  const int most = aim_.must_improve ? 1 : call_.context.options().max_sub_edits;  // pulls repeat by themselves
  for (int sub_edit = 0, cuts = 0; sub_edit < most; ++sub_edit) {
    const bool is_first = sub_edit == 0;
    ++call_.execution.counters.sub_edits;
    RoundOutcome outcome = is_first && !aim_.must_improve ? first_answer() : rounds(Projection::from_goal);
    Acceptance acceptance = accept(outcome, is_first);
    report(outcome, acceptance);
    if (acceptance.fraction == 0) return;
    call_.accepted = std::move(acceptance.state);
    call_.execution.checkpoint();
    edit.path.push_back(call_.accepted.controls);
    const bool arrived = call_.accepted.controls == call_.context.stored(aim_.controls);
    if (!arrived && call_.is_to_hand_over()) throw Interrupted("handing over an accepted state");
    const double energy_after = energy_of(call_.accepted);
    const bool is_part = fraction_ < 1 || acceptance.is_part;
    if (!is_part && !edit.blocked) return;
    if (is_part && !edit.blocked && energy_after < energy_before_ && cuts < max_cuts) {
      ++cuts;
      --sub_edit;  // settled within reach of a search: no sub-edit toward the whole goal yet
    } else if (energy_after > (1 - least_energy_drop) * energy_before_) {
      break;
    }
    energy_before_ = energy_after;
  }
  edit.blocked = true;  // ended before it settled
}

}  // namespace

bool moves_pinned_controls(const EditOptions& options, const Controls& from, const Controls& to) {
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

void run_sub_edits(EditCall& call, const Aim& aim) { SubEditLoop(call, aim).run(); }

void run_sub_edits_by_steps(EditCall& call, const Aim& aim) {
  const ControlLimits& limits = call.context.limits();
  const std::vector<Index>& rows = call.context.rotation_rows();
  const std::vector<Index> turning = call.context.deformation().rotation_rows();
  const auto turn = [&] { return largest_rotation(call.accepted.controls, aim.controls, turning); };
  const auto part = [&] { return limits.fraction_of_longest_step(call.accepted.controls, aim.controls); };
  const auto next_goal = [&] {
    const double fraction = std::min(largest_turn / turn(), part());
    return limits.nearest(interpolate(call.accepted.controls, aim.controls, fraction, rows));
  };
  const int steps = static_cast<int>(std::ceil(std::max(turn() / largest_turn, 1 / part())));
  for (int step = 1; step < steps; ++step) {
    const Controls before = call.accepted.controls;
    run_sub_edits(call, {next_goal(), aim.surface, aim.must_improve});
    if (call.accepted.controls == before) return;
  }
  run_sub_edits(call, {next_goal(), aim.surface, aim.must_improve});
}

}  // namespace stiv
