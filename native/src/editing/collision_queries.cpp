// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/collision_queries.hpp"

#include <algorithm>

#include "editing/validation.hpp"
#include "position_rows.hpp"
#include "stiv/coordinate_range.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

double first_time(const Events& events) {
  double first = never;
  for (const Event& event : events) first = std::min(first, event.time);
  return first;
}

/// Marks vertices whose position differs in any bit.
std::vector<unsigned char> moved_vertices(const PositionsView& from, const PositionsView& to) {
  std::vector<unsigned char> moved(from.rows());
  for (Index vertex = 0; vertex < from.rows(); ++vertex) moved[vertex] = from.row(vertex) != to.row(vertex);
  return moved;
}

}  // namespace

CollisionQueries::CollisionQueries(const EditContext& context)
    : context_(context),
      detector_(context.shared_surface(), {.broad_phase = context.options().broad_phase}),
      cache_(detector_),
      intersections_(context.shared_surface()),
      excluded_(context.shared_surface(), context.options().excluded),
      no_separations_(context.surface().bodies().size(), 0) {
  const EditOptions& options = context.options();
  if (!excluded_.empty()) depth_.emplace(context.shared_surface(), options.excluded, context.least_separation());
  if (options.narrow_phase != NarrowPhase::conservative)
    round_detector_.emplace(context.shared_surface(), DetectorOptions{options.broad_phase, options.narrow_phase});
}

void CollisionQueries::check_start(const Positions& q, Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  StaticPairs found = intersections_.find_all(q, execution);
  if (depth_ && !depth_->begun()) depth_->begin(q, found.faces);
  found.faces = excluded_.others(found.faces);
  if (found.empty()) return;
  const std::string message = describe(context_.surface(), found);
  throw StartIntersectsError(message, std::move(found.faces));
}

std::optional<Events> CollisionQueries::find(const Positions& from, const Positions& to, PairLimit limit,
                                             Execution& execution) {
  const ScopedTimer timer(execution.timings.detection);
  Detector& detector = round_detector_ ? *round_detector_ : detector_;
  return find_not_excluded(detector, context_.centred(from), context_.centred(to), context_.round_proximity(), limit,
                           execution);
}

Events CollisionQueries::find_cached(const Positions& from, State& to, Execution& execution) {
  if (round_detector_) return {};
  double placing = 0;
  const auto place = [&](std::span<const Index> vertices) {
    const ScopedTimer timer(placing);
    Positions end = context_.deformation().surface_rows(to.controls, vertices, execution);
    flush_below_range(end);
    put_rows(to.surface, vertices, end);
    return CandidateCache::Rows{context_.centred(rows_of(from, vertices)), context_.centred(end)};
  };
  Events events;
  {
    const ScopedTimer timer(execution.timings.detection);
    events = cache_.find(place, context_.round_proximity(), execution);
    excluded_.remove_from(events);
  }
  execution.timings.detection -= placing;
  execution.timings.deformation += placing;
  return events;
}

void CollisionQueries::prune_cache(const Positions& from, const Positions& to, Execution& execution) {
  if (round_detector_) return;
  const ScopedTimer timer(execution.timings.detection);
  cache_.prune(context_.centred(from), context_.centred(to), context_.round_proximity(), execution);
}

std::optional<Events> CollisionQueries::find_not_excluded(Detector& detector, const Positions& from,
                                                          const Positions& to, const Proximity& proximity,
                                                          PairLimit limit, Execution& execution) const {
  std::optional<Events> events = limit == PairLimit::ignored
                                     ? detector.find(from, to, proximity, execution)
                                     : detector.find_within_pair_limit(from, to, proximity, execution);
  if (events) excluded_.remove_from(*events);
  return events;
}

bool CollisionQueries::rounds_prove_clearance() const {
  return !round_detector_ && context_.round_proximity().separation == context_.proximity().separation;
}

std::optional<double> CollisionQueries::earliest_time(const Positions& from, const Positions& to, PairLimit limit,
                                                      Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  const Proximity& proximity = context_.proximity();
  const Positions start = context_.centred(from), end = context_.centred(to);
  if (!excluded_.empty()) {
    const auto events = find_not_excluded(detector_, start, end, proximity, limit, execution);
    return events ? std::optional(first_time(*events)) : std::nullopt;
  }
  if (limit == PairLimit::ignored) return detector_.earliest_time(start, end, proximity, execution);
  return detector_.earliest_time_within_pair_limit(start, end, proximity, execution);
}

bool CollisionQueries::is_intersection_free(const Positions& from, const Positions& to, Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  if (excluded_.empty()) return intersections_.is_free(to, moved_vertices(from, to), execution);
  StaticPairs found = intersections_.find_all(to, execution);
  const IndexPairs all = found.faces;
  found.faces = excluded_.others(found.faces);
  if (!found.empty() || all.size() > intersections_.find(from, execution).size()) return false;
  return !depth_->is_deeper(to, all);
}

bool CollisionQueries::is_step_free(const PositionsView& from, const PositionsView& to, Execution& execution) {
  // The largest separation keeps the cached boxes of vertices at rest valid; no pair has to keep that distance.
  Proximity touching;
  touching.separation = context_.proximity().separation;
  touching.by_bodies = &no_separations_;
  return detector_.earliest_time(context_.centred(from), context_.centred(to), touching, execution) == never &&
         intersections_.is_free(to, moved_vertices(from, to), execution);
}

}  // namespace stiv
