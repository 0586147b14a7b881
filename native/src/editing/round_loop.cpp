// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/round_loop.hpp"

#include <algorithm>

#include "stiv/editing/goal.hpp"
#include "stiv/response/resolver.hpp"
#include "stiv/volumes/stiv.hpp"

namespace stiv {

namespace {

/// A sum over a patch can vanish while contacts in it remain, round after round. What a few rounds with patches leave
/// are few contacts; each of them as a constraint of its own then ends the rounds, as long as the constraints kept
/// stay few enough to solve for at once.
constexpr int rounds_with_patches = 2;
constexpr std::size_t most_constraints = 512;

/// Where each control moves its own part of the surface alone, constraints touch few controls, so that thousands can be
/// met together, and do not stiffen what lies between them: there each contact is one from the first round on.
constexpr std::size_t most_local_constraints = 8192;

/// Where even this part of the way has too many pairs near each other, it is not the motion that makes them.
constexpr double shortest_part = 0x1p-16;

struct Measurement {
  std::vector<Stiv> stivs;  ///< none if no event tells a way out
  Index patches = 0;
  bool each_contact = false;
};

std::size_t most_constraints_of(const Problem& problem) {
  return problem.metric().is_local() ? most_local_constraints : most_constraints;
}

bool may_constrain_each_contact(const Problem& problem, int round) {
  if (problem.options().constraints != ConstraintKind::per_patch) return false;
  return round >= rounds_with_patches || problem.metric().is_local();
}

Index patch_count(const std::vector<Index>& labels) {
  return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
}

Measurement measure(const Problem& problem, const State& accepted, const Eigen::VectorXd& areas, int round,
                    std::size_t kept, const RoundOutcome& outcome, Execution& execution) {
  const ScopedTimer timer(execution.timings.volumes);
  const Surface& surface = problem.surface();
  const Events& events = outcome.events;
  const Positions &start = accepted.surface, &end = outcome.candidate.surface;
  const std::size_t most = most_constraints_of(problem), room = most - std::min(kept, most);
  std::vector<Region> regions = earliest_regions(surface, events, start, end);
  std::vector<Index> labels = patch_labels(surface, regions, problem.options().constraints);
  Measurement measured;
  measured.patches = patch_count(labels);
  measured.each_contact = may_constrain_each_contact(problem, round) && regions.size() <= room;
  if (measured.each_contact) {
    if (problem.metric().is_local() && events.size() <= room) regions = contact_regions(surface, events, start, end);
    labels = patch_labels(surface, regions, ConstraintKind::per_contact);
  }
  measured.stivs = interference_volumes(events, regions, labels, end, areas, problem.proximity());
  return measured;
}

/// Those that the time budget ended, if they are of the same sub-edit; new ones else.
RoundProgress& rounds_toward(Problem& problem, const State& accepted, const Controls& goal) {
  std::optional<RoundProgress>& rounds = problem.unfinished_rounds();
  if (!rounds || rounds->accepted != accepted.controls || rounds->goal != goal)
    rounds = RoundProgress{accepted.controls, goal, {}, goal};
  return *rounds;
}

}  // namespace

RoundOutcome run_rounds(Problem& problem, const State& accepted, const Controls& goal, bool at_any_cost,
                        Execution& execution) {
  const EditOptions& options = problem.options();
  const Eigen::VectorXd areas = region_areas(problem.surface(), accepted.surface);
  RoundOutcome outcome;
  outcome.at_any_cost = at_any_cost;
  RoundProgress& progress = rounds_toward(problem, accepted, goal);
  auto& [from, to, kept, p, accumulate, round] = progress;
  for (;; ++round) {
    execution.check();
    execution.report("rounds", static_cast<double>(round) / options.max_rounds);
    outcome.candidate.controls = problem.stored(p);
    outcome.candidate.surface = problem.surface_at(outcome.candidate.controls, execution);
    if (round == options.max_rounds) return outcome;
    std::optional<Events> events =
        problem.find_events(accepted.surface, outcome.candidate.surface, at_any_cost, execution);
    outcome.too_far = !events;
    if (outcome.too_far) return outcome;
    outcome.clear = events->empty();
    if (outcome.clear) return outcome;
    outcome.events = std::move(*events);
    ++execution.counters.rounds;
    if (kept.size() > most_constraints_of(problem) / 2) kept.drop_inactive();
    const Measurement measured = measure(problem, accepted, areas, round, kept.size(), outcome, execution);
    outcome.patches = measured.patches;
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

RoundOutcome run_rounds_within_reach(Problem& problem, const State& accepted, const Controls& goal, double& part,
                                     Execution& execution) {
  for (part = std::min(1.0, 2 * part); part >= shortest_part; part /= 2) {
    const Controls aim = interpolate(accepted.controls, goal, part, problem.rotation_rows());
    RoundOutcome outcome = run_rounds(problem, accepted, aim, false, execution);
    if (!outcome.too_far) return outcome;
  }
  return run_rounds(problem, accepted, interpolate(accepted.controls, goal, part, problem.rotation_rows()), true,
                    execution);
}

}  // namespace stiv
