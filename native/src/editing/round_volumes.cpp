// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/round_volumes.hpp"

#include <algorithm>

#include "stiv/volumes/published.hpp"

namespace stiv {

namespace {

/// A patch's sum can vanish while contacts in it remain. Few contacts are left after this many rounds, and each becomes
/// a separate constraint.
constexpr int rounds_with_patches = 2;
constexpr std::size_t max_coupled_constraints = 512;

/// Where the metric does not couple controls, constraints touch few of them, so thousands can be solved together and do
/// not stiffen the controls between them. Then each contact is a separate constraint in every round.
constexpr std::size_t max_local_constraints = 8192;

bool may_constrain_each_contact(const EditContext& context, int round) {
  const EditOptions& options = context.options();
  if (options.constraints != ConstraintKind::per_patch || options.solver != ConstraintSolver::lcp) return false;
  return round >= rounds_with_patches || context.metric().is_local();
}

Index patch_count(const std::vector<Index>& labels) {
  return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
}

RoundVolumes volumes_as_published(const EditContext& context, const InterferingStep& step, PublishedGradient gradient) {
  RoundVolumes volumes;
  volumes.stivs = published_volumes(context.surface(), step.events, step.start, step.end, step.areas,
                                    context.options().constraints, gradient);
  volumes.patches = static_cast<Index>(volumes.stivs.size());
  return volumes;
}

RoundVolumes relative_volumes(const EditContext& context, const InterferingStep& step, int round,
                              std::size_t accumulated) {
  const Surface& surface = context.surface();
  const std::size_t most = max_constraints(context), room = most - std::min(accumulated, most);
  std::vector<Region> regions = earliest_regions(surface, step.events, step.start, step.end);
  std::vector<Index> labels = patch_labels(surface, regions, context.options().constraints);
  RoundVolumes volumes;
  volumes.patches = patch_count(labels);
  volumes.each_contact = may_constrain_each_contact(context, round) && regions.size() <= room;
  if (volumes.each_contact) {
    if (context.metric().is_local() && step.events.size() <= room)
      regions = contact_regions(surface, step.events, step.start, step.end);
    labels = patch_labels(surface, regions, ConstraintKind::per_contact);
  }
  volumes.stivs = interference_volumes(step.events, regions, labels, step.end, step.areas);
  return volumes;
}

}  // namespace

std::size_t max_constraints(const EditContext& context) {
  return context.metric().is_local() ? max_local_constraints : max_coupled_constraints;
}

RoundVolumes volumes_of_round(const EditContext& context, const InterferingStep& step, int round,
                              std::size_t accumulated, Execution& execution) {
  const ScopedTimer timer(execution.timings.volumes);
  switch (context.options().volumes) {
    case VolumeKind::published:
      return volumes_as_published(context, step, PublishedGradient::whole);
    case VolumeKind::published_frozen:
      return volumes_as_published(context, step, PublishedGradient::frozen);
    case VolumeKind::relative:
      break;
  }
  return relative_volumes(context, step, round, accumulated);
}

}  // namespace stiv
