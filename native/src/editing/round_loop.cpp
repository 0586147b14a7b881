// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/round_loop.hpp"

#include "stiv/response/resolver.hpp"
#include "stiv/volumes/stiv.hpp"

namespace stiv {

namespace {

/// A sum over a patch can vanish while contacts in it remain, round after round. What a few rounds with patches leave
/// are few contacts; each of them as a constraint of its own then ends the rounds, as long as the constraints kept
/// stay few enough to solve for at once.
constexpr int rounds_with_patches = 4;
constexpr std::size_t most_constraints = 512;

bool constrains_each_contact(const EditOptions& options, int round, std::size_t kept, std::size_t regions) {
  return options.constraints == ConstraintKind::per_patch && round >= rounds_with_patches &&
         kept + regions <= most_constraints;
}

struct Measurement {
  std::vector<Stiv> stivs;  ///< none if no event tells a way out
  bool each_contact = false;
};

Measurement measure(const Problem& problem, const State& accepted, const Eigen::VectorXd& areas, int round,
                    std::size_t kept, const RoundOutcome& outcome, Execution& execution) {
  const ScopedTimer timer(execution.timings.volumes);
  const std::vector<Region> regions =
      earliest_regions(problem.surface(), outcome.events, accepted.surface, outcome.candidate.surface);
  Measurement measured;
  measured.each_contact = constrains_each_contact(problem.options(), round, kept, regions.size());
  const ConstraintKind kind = measured.each_contact ? ConstraintKind::per_contact : problem.options().constraints;
  const std::vector<Index> labels = patch_labels(problem.surface(), regions, kind);
  measured.stivs =
      interference_volumes(outcome.events, regions, labels, outcome.candidate.surface, areas, problem.proximity());
  return measured;
}

}  // namespace

RoundOutcome run_rounds(Problem& problem, const State& accepted, const Controls& goal, Execution& execution) {
  const EditOptions& options = problem.options();
  const Eigen::VectorXd areas = region_areas(problem.surface(), accepted.surface);
  RoundOutcome outcome;
  ConstraintSet kept;
  Controls p = goal;
  bool accumulate = true;
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
    if (kept.size() > most_constraints / 2) kept.drop_inactive();
    const Measurement measured = measure(problem, accepted, areas, round, kept.size(), outcome, execution);
    if (!measured.each_contact) outcome.patches = static_cast<Index>(measured.stivs.size());
    const ScopedTimer timer(execution.timings.response);
    std::vector<ControlConstraint> rows = control_constraints(
        measured.stivs, problem.deformation(), outcome.candidate.controls, problem.metric(), accepted.controls);
    if (rows.empty()) return outcome;  // nothing that is free to move can help
    accumulate = accumulate && (round < options.accumulated_rounds || measured.each_contact);
    if (!accumulate) kept = ConstraintSet();
    kept.add(std::move(rows));
    p = kept.project(accumulate ? goal : outcome.candidate.controls, execution);
  }
}

}  // namespace stiv
