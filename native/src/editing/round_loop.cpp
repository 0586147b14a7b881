// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/round_loop.hpp"

#include <algorithm>
#include <functional>

#include "editing/control_interpolation.hpp"
#include "editing/round_volumes.hpp"
#include "stiv/response/resolver.hpp"
#include "stiv/volumes/stiv.hpp"

namespace stiv {

namespace {

/// Where even this part of the way has too many pairs near each other, it is not the motion that makes them.
constexpr double shortest_part = 0x1p-16;

/// Rounds between two questions whether to give up, for which a candidate is placed whole.
constexpr int rounds_before_giving_up = 6;

/// Those that the time budget ended, if they are of the same sub-edit; new ones else.
RoundProgress& rounds_toward(Problem& problem, const State& accepted, const Controls& goal, Projection projection) {
  if (!has_begun_rounds(problem, accepted, goal, projection))
    problem.unfinished_rounds() =
        RoundProgress{accepted.controls, goal, projection, {}, goal, projection == Projection::from_goal};
  return *problem.unfinished_rounds();
}

/// The part of a way, of those that are tried from `part` on, whose rounds the time budget ended; else `part`.
double begun_part(Problem& problem, const State& accepted, Projection projection, double part,
                  const std::function<Controls(double)>& aim_at) {
  const std::optional<RoundProgress>& rounds = problem.unfinished_rounds();
  if (!rounds || rounds->projection != projection || rounds->accepted != accepted.controls) return part;
  for (double begun = part; begun >= shortest_part; begun /= 2)
    if (rounds->goal == aim_at(begun)) return begun;
  return part;
}

/// Adds the constraints of the events to those kept; false if nothing that is free to move can help.
bool constrain(Problem& problem, const State& accepted, const Eigen::VectorXd& areas, const Events& events,
               RoundOutcome& outcome, RoundProgress& progress, Execution& execution) {
  const EditOptions& options = problem.options();
  ConstraintSet& kept = progress.kept;
  ++execution.counters.rounds;
  if (kept.size() > most_constraints(problem) / 4) kept.drop_inactive();
  const Measurement measured = measure(problem, {events, accepted.surface, outcome.candidate.surface, areas},
                                       progress.round, kept.size(), execution);
  outcome.patches = measured.patches;
  const ScopedTimer timer(execution.timings.response);
  std::vector<ControlConstraint> rows =
      control_constraints(measured.stivs, problem.deformation(), outcome.candidate.controls, problem.metric(),
                          accepted.controls, &execution);
  if (rows.empty()) return false;
  progress.accumulate = progress.accumulate && options.solver == ConstraintSolver::lcp &&
                        (progress.round < options.accumulated_rounds || measured.each_contact);
  if (!progress.accumulate) kept = ConstraintSet();
  kept.add(std::move(rows));
  return true;
}

/// Events on the path to the candidate: among cached candidates or, if none of these interferes, of all pairs. The
/// surface is up to date at the events, and everywhere if there is none. Nothing if the path exceeds the pair limit.
std::optional<Events> find_some(Problem& problem, const State& accepted, RoundOutcome& outcome, RoundProgress& progress,
                                Execution& execution) {
  State& candidate = outcome.candidate;
  const bool begins = !progress.begun;
  if (begins) {
    candidate.surface = problem.surface_at(candidate.controls, execution);
    problem.prune_cached_candidates(accepted.surface, candidate.surface, execution);
    progress.begun = true;
  }
  Events events = problem.find_cached_events(accepted.surface, candidate, execution);
  if (!events.empty()) return events;
  if (!begins) candidate.surface = problem.surface_at(candidate.controls, execution);
  return problem.find_events(accepted.surface, candidate.surface, outcome.pair_limit, execution);
}

}  // namespace

bool has_begun_rounds(Problem& problem, const State& accepted, const Controls& goal, Projection projection) {
  const std::optional<RoundProgress>& rounds = problem.unfinished_rounds();
  return rounds && rounds->accepted == accepted.controls && rounds->goal == goal && rounds->projection == projection;
}

RoundOutcome run_rounds(Problem& problem, const State& accepted, const Controls& goal, Projection projection,
                        PairLimit pair_limit, const StatePredicate& is_diverging, Execution& execution) {
  const EditOptions& options = problem.options();
  const bool is_lcp = options.solver == ConstraintSolver::lcp;
  const Eigen::VectorXd areas = region_areas(problem.surface(), accepted.surface);
  RoundOutcome outcome;
  outcome.pair_limit = pair_limit;
  outcome.candidate.surface = accepted.surface;
  RoundProgress& progress = rounds_toward(problem, accepted, goal, projection);
  auto& [from, to, kind, kept, p, accumulate, round, begun, found, constrained] = progress;
  for (;; ++round) {
    execution.check();
    execution.report("rounds", static_cast<double>(round) / options.max_rounds);
    outcome.candidate.controls = problem.stored(p);
    const bool last = round == options.max_rounds;
    const bool asks = is_diverging && accumulate && round > 0 && round % rounds_before_giving_up == 0;
    if (last || asks || found) outcome.candidate.surface = problem.surface_at(outcome.candidate.controls, execution);
    outcome.given_up = !last && asks && is_diverging(outcome.candidate);
    if (last || outcome.given_up) return outcome;
    if (!found) {
      std::optional<Events> events = find_some(problem, accepted, outcome, progress, execution);
      outcome.too_far = !events;
      if (outcome.too_far) return outcome;
      found = std::move(events);  // only now: a search that is interrupted has found nothing out
      execution.note_gain();      // kept with the problem, see RoundProgress
    }
    outcome.clear = found->empty();
    if (outcome.clear) return outcome;
    if (!constrained && !constrain(problem, accepted, areas, *found, outcome, progress, execution)) {
      outcome.events = *found;  // a call that takes these rounds up again asks for them once more
      outcome.candidate.surface = problem.surface_at(outcome.candidate.controls, execution);
      return outcome;
    }
    constrained = true;  // what ends here is not to add them twice
    const ScopedTimer timer(execution.timings.response);
    const Controls& from = accumulate ? goal : outcome.candidate.controls;
    p = is_lcp ? kept.project(from, execution) : kept.project_as_equations(from, execution);
    constrained = false;
    outcome.events = std::move(*found);
    found.reset();
    execution.note_gain();
  }
}

RoundOutcome run_rounds_within_reach(Problem& problem, const State& accepted, const Controls& goal,
                                     Projection projection, double& part, const StatePredicate& is_diverging,
                                     Execution& execution) {
  const auto aim_at = [&](double share) {
    return interpolate(accepted.controls, goal, share, problem.rotation_rows());
  };
  for (part = begun_part(problem, accepted, projection, std::min(1.0, 2 * part), aim_at); part >= shortest_part;
       part /= 2) {
    const Controls aim = aim_at(part);
    RoundOutcome outcome =
        run_rounds(problem, accepted, aim, projection, PairLimit::respected, is_diverging, execution);
    if (!outcome.too_far) return outcome;
    rounds_toward(problem, accepted, aim_at(part / 2), projection);
    execution.note_gain();  // a call that ends here is taken up with the half
  }
  return run_rounds(problem, accepted, aim_at(part), projection, PairLimit::ignored, is_diverging, execution);
}

}  // namespace stiv
