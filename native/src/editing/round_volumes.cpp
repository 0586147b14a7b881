// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/round_volumes.hpp"

#include <algorithm>

#include "stiv/volumes/published.hpp"

namespace stiv {

namespace {

/// A sum over a patch can vanish while contacts in it remain, round after round. What a few rounds with patches leave
/// are few contacts; each of them as a constraint of its own then ends the rounds, as long as the constraints kept
/// stay few enough to solve for at once.
constexpr int rounds_with_patches = 2;
constexpr std::size_t most_coupled_constraints = 512;

/// Where each control moves its own part of the surface alone, constraints touch few controls, so that thousands can be
/// met together, and do not stiffen what lies between them: there each contact is one from the first round on.
constexpr std::size_t most_local_constraints = 8192;

bool may_constrain_each_contact(const Problem& problem, int round) {
  const EditOptions& options = problem.options();
  if (options.constraints != ConstraintKind::per_patch || options.solver != ConstraintSolver::lcp) return false;
  return round >= rounds_with_patches || problem.metric().is_local();
}

Index patch_count(const std::vector<Index>& labels) {
  return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
}

Measurement measure_as_published(const Problem& problem, const InterferingStep& step, PublishedGradient gradient) {
  Measurement measured;
  measured.stivs = published_volumes(problem.surface(), step.events, step.start, step.end, step.areas,
                                     problem.options().constraints, gradient);
  measured.patches = static_cast<Index>(measured.stivs.size());
  return measured;
}

Measurement measure_relative(const Problem& problem, const InterferingStep& step, int round, std::size_t kept) {
  const Surface& surface = problem.surface();
  const std::size_t most = most_constraints(problem), room = most - std::min(kept, most);
  std::vector<Region> regions = earliest_regions(surface, step.events, step.start, step.end);
  std::vector<Index> labels = patch_labels(surface, regions, problem.options().constraints);
  Measurement measured;
  measured.patches = patch_count(labels);
  measured.each_contact = may_constrain_each_contact(problem, round) && regions.size() <= room;
  if (measured.each_contact) {
    if (problem.metric().is_local() && step.events.size() <= room)
      regions = contact_regions(surface, step.events, step.start, step.end);
    labels = patch_labels(surface, regions, ConstraintKind::per_contact);
  }
  measured.stivs = interference_volumes(step.events, regions, labels, step.end, step.areas);
  return measured;
}

}  // namespace

std::size_t most_constraints(const Problem& problem) {
  return problem.metric().is_local() ? most_local_constraints : most_coupled_constraints;
}

Measurement measure(const Problem& problem, const InterferingStep& step, int round, std::size_t kept,
                    Execution& execution) {
  const ScopedTimer timer(execution.timings.volumes);
  switch (problem.options().volumes) {
    case VolumeKind::published:
      return measure_as_published(problem, step, PublishedGradient::whole);
    case VolumeKind::published_frozen:
      return measure_as_published(problem, step, PublishedGradient::frozen);
    case VolumeKind::relative:
      break;
  }
  return measure_relative(problem, step, round, kept);
}

}  // namespace stiv
