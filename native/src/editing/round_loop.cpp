// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/round_loop.hpp"

#include "stiv/response/resolver.hpp"
#include "stiv/volumes/stiv.hpp"

namespace stiv {

namespace {

/// STIVs of the events, one a patch; none if no event tells a way out.
std::vector<Stiv> measure(const Problem& problem, const State& accepted, const Eigen::VectorXd& areas,
                          RoundOutcome& outcome, Execution& execution) {
  const ScopedTimer timer(execution.timings.volumes);
  const std::vector<Region> regions =
      earliest_regions(problem.surface(), outcome.events, accepted.surface, outcome.candidate.surface);
  const std::vector<Index> labels = patch_labels(problem.surface(), regions, problem.options().constraints);
  std::vector<Stiv> stivs =
      interference_volumes(outcome.events, regions, labels, outcome.candidate.surface, areas, problem.proximity());
  outcome.patches = static_cast<Index>(stivs.size());
  return stivs;
}

}  // namespace

RoundOutcome run_rounds(Problem& problem, const State& accepted, const Controls& goal, Execution& execution) {
  const EditOptions& options = problem.options();
  const Eigen::VectorXd areas = region_areas(problem.surface(), accepted.surface);
  RoundOutcome outcome;
  ConstraintSet kept;
  Controls p = goal;
  for (int round = 0;; ++round) {
    execution.check();
    execution.report("rounds", static_cast<double>(round) / options.max_rounds);
    outcome.candidate.controls = problem.stored(p);
    outcome.candidate.surface = problem.surface_at(outcome.candidate.controls, execution);
    if (round == options.max_rounds) return outcome;
    Events events = problem.find_events(accepted.surface, outcome.candidate.surface, execution);
    outcome.clear = events.empty();
    if (outcome.clear) return outcome;
    outcome.events = std::move(events);
    ++execution.counters.rounds;
    const std::vector<Stiv> stivs = measure(problem, accepted, areas, outcome, execution);
    const ScopedTimer timer(execution.timings.response);
    std::vector<ControlConstraint> rows = control_constraints(stivs, problem.deformation(), outcome.candidate.controls,
                                                              problem.metric(), accepted.controls);
    if (rows.empty()) return outcome;  // nothing that is free to move can help
    const bool accumulate = round < options.accumulated_rounds;
    ConstraintSet alone;
    ConstraintSet& constraints = accumulate ? kept : alone;
    constraints.add(std::move(rows));
    p = constraints.project(accumulate ? goal : outcome.candidate.controls, execution);
  }
}

}  // namespace stiv
