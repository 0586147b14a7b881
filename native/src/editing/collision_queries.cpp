// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/collision_queries.hpp"

#include <algorithm>

#include "acceptance/intersection/near_pairs.hpp"
#include "editing/validation.hpp"
#include "position_rows.hpp"
#include "stiv/acceptance/step_check.hpp"
#include "stiv/coordinate_range.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// The vertices of a surface among those of the scene, ascending, in which those of obstacles follow.
std::span<const Index> before_obstacles(std::span<const Index> vertices, const Positions& surface) {
  const auto end = std::lower_bound(vertices.begin(), vertices.end(), static_cast<Index>(surface.rows()));
  return vertices.first(static_cast<std::size_t>(end - vertices.begin()));
}

double first_time(const Events& events) {
  double first = never;
  for (const Event& event : events) first = std::min(first, event.time);
  return first;
}

std::shared_ptr<const Surface> without_pairs(const Surface& surface, const BodyPairs& pairs,
                                             const std::vector<unsigned char>& left_out) {
  SurfaceDefinition definition = surface.definition();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (left_out[k] != 0) definition.ignored.push_back(pairs[k]);
  return std::make_shared<Surface>(std::move(definition));
}

bool has_deviation_tests(const EditContext& context) {
  return context.obstacles().rows() == 0 && context.options().excluded.empty() && context.options().overlapping.empty();
}

/// @param rows of the scene
ExcludedPairs excluded_pairs(const EditContext& context, const Controls& start, SceneRows& rows, Execution& execution) {
  const EditOptions& options = context.options();
  ExcludedPairs::Given given{options.excluded, options.parts_may_cut, options.touching, {}, {}};
  given.separation = [&](Index a, Index b) { return context.proximity().between(a, b).separation; };
  for (const auto& [a, b] : options.overlapping) given.overlapping.push_back(std::minmax(a, b));
  sort_unique(given.overlapping);
  if (options.excluded.empty() && options.touching.empty())
    return {context.shared_surface(), given, Positions(), context.least_separation(), execution};
  const Positions surface = context.surface_at(start, execution);
  return {context.shared_surface(), given, rows.with_rest(surface), context.least_separation(), execution};
}

}  // namespace

CollisionQueries::Guard::Guard(std::shared_ptr<const Surface> guarded, const EditContext& context)
    : surface(std::move(guarded)),
      detector(surface, {.broad_phase = context.options().broad_phase}),
      cache(detector, static_cast<Index>(context.obstacles().rows())),
      intersections(surface, {.lists_near_pairs = has_deviation_tests(context),
                              .resting = static_cast<Index>(context.obstacles().rows())}) {
  const EditOptions& options = context.options();
  if (options.narrow_phase != NarrowPhase::conservative)
    round_detector.emplace(surface, DetectorOptions{options.broad_phase, options.narrow_phase});
}

CollisionQueries::CollisionQueries(const EditContext& context, const Controls& start, Execution& execution)
    : context_(context),
      start_(context.obstacles()),
      end_(context.obstacles()),
      centred_start_(context.centred_obstacles()),
      centred_end_(context.centred_obstacles()),
      guard_(std::make_unique<Guard>(context.shared_surface(), context)),
      excluded_(excluded_pairs(context, start, start_, execution)),
      no_separations_(context.surface().bodies().size(), 0) {
  const EditOptions& options = context.options();
  if (!options.excluded.empty()) depth_.emplace(context.shared_surface(), options.excluded, context.least_separation());
  if (options.overlapping.empty()) return;
  overlap_.emplace(context.surface(), options.overlapping, context.least_separation());
  overlapping_.assign(overlap_->pairs().size(), 0);
}

void CollisionQueries::check_start(const Positions& surface, Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  const Positions& q = end_.with_rest(surface);
  const bool is_first = overlap_ && !overlap_->begun();
  if (is_first) overlap_->begin(q, execution);
  if (overlap_ && !is_first && overlap_->is_deeper(q, execution))
    throw StartIntersectsError("bodies that may overlap would overlap more than at the start", {});
  guard_pairs_apart_at(surface, execution);
  StaticPairs found = guard_->intersections.find_all(q, execution);
  if (depth_ && !depth_->begun()) depth_->begin(q, found.faces);
  found.faces = excluded_.others(found.faces, q);
  if (!found.empty()) {
    const std::string message = describe(context_.surface(), found);
    throw StartIntersectsError(message, std::move(found.faces));
  }
  prepare_searches(surface, execution);
}

/// Does what the first searches and tests from a surface would do for vertices that never move.
void CollisionQueries::prepare_searches(const Positions& surface, Execution& execution) {
  guard_->detector.prepare(context_.centred(surface, centred_start_, execution), context_.round_proximity(), execution);
  if (context_.obstacles().rows() == 0) return;
  prune_cache(surface, surface, execution);
}

std::pair<const Positions&, const Positions&> CollisionQueries::at_events(const Events& events, const Positions& from,
                                                                          const Positions& to) {
  if (context_.options().volumes != VolumeKind::relative) return {start_.with_rest(from), end_.with_rest(to)};
  return {start_.with_rest_at(events, from), end_.with_rest_at(events, to)};
}

/// Guards the watched pairs of bodies that are apart in the accepted surface, and no others.
void CollisionQueries::guard_pairs_apart_at(const Positions& accepted, Execution& execution) {
  if (!overlap_ || (guarded_at_.rows() == accepted.rows() && guarded_at_ == accepted)) return;
  guarded_at_ = accepted;
  const std::vector<unsigned char>& overlapping = overlap_->overlapping(start_.with_rest(accepted), execution);
  if (overlapping == overlapping_) return;
  overlapping_ = overlapping;
  guard_ = std::make_unique<Guard>(without_pairs(context_.surface(), overlap_->pairs(), overlapping_), context_);
  intersecting_ = {};
}

std::optional<Events> CollisionQueries::find(const Positions& from, const Positions& to, PairLimit limit,
                                             Execution& execution) {
  const ScopedTimer timer(execution.timings.detection);
  guard_pairs_apart_at(from, execution);
  Detector& detector = guard_->round_detector ? *guard_->round_detector : guard_->detector;
  std::optional<Events> events =
      find_not_excluded(detector, context_.centred(from, centred_start_, execution),
                        context_.centred(to, centred_end_, execution), context_.round_proximity(), limit, execution);
  if (events) excluded_.add_contacts(*events, from, to);
  return events;
}

/// Rows of a surface and of the obstacles after it, relative to the center.
Positions CollisionQueries::centred_rows(const Positions& q, std::span<const Index> vertices,
                                         const Execution& execution) const {
  constexpr Index rows_per_chunk = 1024;
  const Index own = static_cast<Index>(q.rows());
  Positions some(static_cast<Index>(vertices.size()), 3);
  execution.for_chunks(static_cast<Index>(some.rows()), rows_per_chunk, [&](Index begin, Index end, Index) {
    for (Index k = begin; k < end; ++k) {
      const Index vertex = vertices[at(k)];
      some.row(k) = vertex < own ? q.row(vertex) : context_.obstacles().row(vertex - own);
    }
    context_.centre(some.middleRows(begin, end - begin));
  });
  return some;
}

/// Of all vertices.
std::vector<unsigned char> CollisionQueries::moved(const PositionsView& from, const PositionsView& to,
                                                   const Execution& execution) const {
  std::vector<unsigned char> moved = moved_vertices(from, to, execution);
  moved.resize(at(context_.surface().vertex_count()), 0);
  return moved;
}

void CollisionQueries::place_rows(std::span<const Index> vertices, State& state, const Execution& execution) const {
  Positions some = context_.deformation().surface_rows(state.controls, vertices, execution);
  flush_below_range(some);
  put_rows(state.surface, vertices, some);
}

Events CollisionQueries::find_cached(const Positions& from, State& to, CandidateRows rows, Execution& execution) {
  if (guard_->round_detector) return {};
  guard_pairs_apart_at(from, execution);
  double placing = 0;
  const auto place = [&](std::span<const Index> vertices) {
    const ScopedTimer timer(placing);
    if (rows == CandidateRows::to_be_placed) place_rows(before_obstacles(vertices, from), to, execution);
    return CandidateCache::Rows{centred_rows(from, vertices, execution), centred_rows(to.surface, vertices, execution)};
  };
  Events events;
  {
    const ScopedTimer timer(execution.timings.detection);
    events = guard_->cache.find(place, context_.round_proximity(), execution);
    const auto row_of = [&](const Positions& surface) {
      return [&](Index vertex) -> Vector3 {
        const auto own = static_cast<Index>(surface.rows());
        if (vertex < own) return surface.row(vertex);
        return context_.obstacles().row(vertex - own);
      };
    };
    excluded_.remove_from(events, *context_.proximity().reference, {row_of(from), row_of(to.surface)});
  }
  execution.timings.detection -= placing;
  execution.timings.deformation += placing;
  return events;
}

void CollisionQueries::prune_cache(const Positions& from, const Positions& to, Execution& execution) {
  if (guard_->round_detector) return;
  const ScopedTimer timer(execution.timings.detection);
  guard_pairs_apart_at(from, execution);
  guard_->cache.prune(context_.centred(from, centred_start_, execution), context_.centred(to, centred_end_, execution),
                      context_.round_proximity(), execution);
}

std::optional<Events> CollisionQueries::find_not_excluded(Detector& detector, const Positions& from,
                                                          const Positions& to, const Proximity& proximity,
                                                          PairLimit limit, Execution& execution) const {
  std::optional<Events> events = limit == PairLimit::ignored
                                     ? detector.find(from, to, proximity, execution)
                                     : detector.find_within_pair_limit(from, to, proximity, execution);
  if (events)
    excluded_.remove_from(*events, *context_.proximity().reference,
                          {[&](Index vertex) -> Vector3 { return from.row(vertex); },
                           [&](Index vertex) -> Vector3 { return to.row(vertex); }});
  return events;
}

bool CollisionQueries::rounds_prove_clearance() const {
  return !guard_->round_detector && context_.round_proximity().separation == context_.proximity().separation;
}

std::optional<double> CollisionQueries::earliest_time(const Positions& from, const Positions& to, PairLimit limit,
                                                      Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  guard_pairs_apart_at(from, execution);
  const Proximity& proximity = context_.proximity();
  const Positions& start = context_.centred(from, centred_start_, execution);
  const Positions& end = context_.centred(to, centred_end_, execution);
  if (!excluded_.empty()) {
    const auto events = find_not_excluded(guard_->detector, start, end, proximity, limit, execution);
    return events ? std::optional(first_time(*events)) : std::nullopt;
  }
  if (limit == PairLimit::ignored) return guard_->detector.earliest_time(start, end, proximity, execution);
  return guard_->detector.earliest_time_within_pair_limit(start, end, proximity, execution);
}

double CollisionQueries::free_fraction(const Positions& from, const Positions& to, Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  guard_pairs_apart_at(from, execution);
  if (!passes_static_test(from, to, execution)) return 0.5;
  return overlap_ ? overlap_->free_fraction(start_.with_rest(from), end_.with_rest(to), execution) : 1;
}

bool CollisionQueries::passes_static_test(const Positions& from, const Positions& to, Execution& execution) {
  const Positions& end = end_.with_rest(to);
  if (excluded_.empty()) return guard_->intersections.is_free(end, moved(from, to, execution), execution);
  StaticPairs found = guard_->intersections.find_all(end, execution);
  const IndexPairs all = found.faces;
  found.faces = excluded_.others(found.faces, end);
  if (!found.empty()) return false;
  const IntersectionCount intersecting = excluded_.count(all, end);
  if (excluded_.are_more(intersecting, intersecting_at(from, execution))) return false;
  if (depth_ && depth_->is_deeper(end, all)) return false;
  intersecting_ = {to, intersecting};
  return true;
}

/// Of excluded pairs, at an accepted surface.
const IntersectionCount& CollisionQueries::intersecting_at(const Positions& accepted, Execution& execution) {
  const Positions& known = intersecting_.surface;
  if (known.rows() != accepted.rows() || known != accepted) {
    const Positions& q = start_.with_rest(accepted);
    intersecting_ = {accepted, excluded_.count(guard_->intersections.find(q, execution), q)};
  }
  return intersecting_.count;
}

bool CollisionQueries::is_step_free(const PositionsView& from, const PositionsView& to, Execution& execution) {
  // The largest separation keeps the cached boxes of vertices at rest valid; no pair has to keep that distance.
  Proximity touching;
  touching.separation = context_.proximity().separation;
  touching.by_bodies = &no_separations_;
  const Positions& start = context_.centred(from, centred_start_, execution);
  const Positions& end = context_.centred(to, centred_end_, execution);
  // As most steps are no longer than rounding, the last search has mostly found all pairs that can touch.
  std::optional<double> first = guard_->cache.earliest_contact(start, end, touching, execution);
  if (!first) first = guard_->detector.earliest_time(start, end, touching, execution);
  return *first == never && is_end_free(from, to, execution);
}

bool CollisionQueries::is_end_free(const PositionsView& from, const PositionsView& to, Execution& execution) {
  if (const auto near = deviation_test(from))
    if (const std::optional<bool> is_free = near->is_free(to, execution)) return *is_free;
  return guard_->intersections.is_free(end_.with_rest(to), moved(from, to, execution), execution);
}

std::shared_ptr<const DeviationTest> CollisionQueries::deviation_test(const PositionsView& accepted) const {
  return excluded_.empty() ? guard_->intersections.deviation_test(accepted) : nullptr;
}

}  // namespace stiv
