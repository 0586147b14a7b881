// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/edit_context.hpp"

#include <algorithm>

#include "editing/effective_separation.hpp"
#include "editing/validation.hpp"
#include "position_rows.hpp"
#include "stiv/coordinate_range.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

std::shared_ptr<const Surface> fitting(std::shared_ptr<const Surface> surface,
                                       const std::shared_ptr<const Deformation>& deformation) {
  if (!surface || !deformation) throw InputError("a surface and a deformation are needed");
  check_fit(*surface, *deformation);
  return surface;
}

EditOptions checked(EditOptions options, Index control_count) {
  check_options(options, control_count);
  if (!options.single_precision)
    options.storage.clear();
  else if (options.storage.empty())
    options.storage.push_back({0, control_count, Eigen::Matrix4d::Identity()});
  return options;
}

std::unique_ptr<Metric> metric_of(const Deformation& deformation, const EditOptions& options) {
  const MetricOptions metric{options.smoothness, options.weights, options.weight_axes};
  if (options.metric == MetricKind::controls) return make_control_metric(metric, deformation.control_count());
  return deformation.metric(metric);
}

/// Rotation vectors that may be composed as rotations: not those with pinned coordinates, which that would change.
std::vector<Index> free_rotation_rows(const Deformation& deformation, const Eigen::VectorXd& weights) {
  std::vector<Index> rows = deformation.rotation_rows();
  if (weights.size() == 0 || weights.size() == deformation.control_count()) return rows;
  rows.erase(std::remove_if(rows.begin(), rows.end(),
                            [&](Index row) { return (weights.segment<3>(3 * row).array() == 0).any(); }),
             rows.end());
  return rows;
}

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

double energy(const Positions& a, const Positions& b) { return 0.5 * (a - b).squaredNorm(); }

Problem::Problem(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
                 const Controls& controls, EditOptions options)
    : surface_(fitting(std::move(surface), deformation)),
      deformation_(std::move(deformation)),
      options_(checked(std::move(options), deformation_->control_count())),
      rotation_rows_(free_rotation_rows(*deformation_, options_.weights)),
      metric_(metric_of(*deformation_, options_)),
      detector_(surface_, {.broad_phase = options_.broad_phase}),
      candidate_cache_(detector_),
      intersections_(surface_),
      excluded_(surface_, options_.excluded),
      no_separations_(surface_->bodies().size(), 0) {
  check_controls(controls, "controls");
  const Positions q = deformation_->surface_in_range(controls);
  surface_->check_positions(q);
  if (q.rows() > 0) centre_ = (q.colwise().minCoeff() + q.colwise().maxCoeff()) / 2;
  reference_ = centred(q);
  const MovingExtent extent = moving_extent(*surface_, *deformation_, q);
  diagonal_ = extent.diagonal;
  const double least = least_separation(extent, controls, options_.storage, deformation_->rotation_rows());
  set_proximity(extent, least);
  if (!excluded_.empty()) depth_.emplace(surface_, options_.excluded, least);
  if (options_.narrow_phase != NarrowPhase::conservative)
    round_detector_.emplace(surface_, DetectorOptions{options_.broad_phase, options_.narrow_phase});
}

void Problem::set_proximity(const MovingExtent& extent, double least) {
  const std::vector<BodyPairSeparation>& pairs = options_.pair_separations;
  const bool touching = options_.volumes != VolumeKind::relative && options_.separation == 0 && pairs.empty();
  options_.separation = touching ? least : separation_in_force(options_.separation, extent, least);
  proximity_ = {options_.separation, options_.keep, nullptr, &reference_, options_.keep_between};
  if (!pairs.empty()) {
    body_separations_ = body_separations(*surface_, pairs, options_.separation, extent, least);
    proximity_.separation = body_separations_->largest();
    proximity_.by_bodies = &*body_separations_;
  }
  proximity_of_rounds_ = proximity_;
  if (touching) proximity_of_rounds_.separation = 0;
}

void Problem::check_controls(const Controls& controls, const char* what) const {
  const Index count = deformation_->control_count();
  if (controls.rows() != count)
    throw InputError(std::string(what) + " has shape (" + std::to_string(controls.rows()) +
                     ", 3), the deformation needs (" + std::to_string(count) + ", 3)");
  for (Index row = 0; row < count; ++row)
    if (!controls.row(row).allFinite())
      throw InputError(std::string(what) + ": " + describe_control(*surface_, *deformation_, row) +
                       ": coordinate is not finite");
  stored(controls);  // refuses what single precision cannot hold
}

void Problem::check_start(const Positions& q, Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  StartIntersections found = find_static_pairs(intersections_, q, execution);
  if (depth_ && !depth_->begun()) depth_->begin(q, found.faces);
  found.faces = excluded_.others(found.faces);
  if (found.empty()) return;
  const std::string message = describe(*surface_, found);
  throw StartIntersectsError(message, std::move(found.faces));
}

Positions Problem::centred(const PositionsView& q) const {
  Positions about_centre = q.rowwise() - centre_;
  flush_below_range(about_centre);
  return about_centre;
}

Controls Problem::stored(const Controls& controls) const { return as_stored(controls, options_.storage); }

Positions Problem::surface_at(const Controls& controls, Execution& execution) const {
  const ScopedTimer timer(execution.timings.deformation);
  return deformation_->surface_in_range(controls, execution);
}

std::optional<Events> Problem::find_events(const Positions& from, const Positions& to, PairLimit limit,
                                           Execution& execution) {
  const ScopedTimer timer(execution.timings.detection);
  const Positions start = centred(from), end = centred(to);
  Detector& detector = round_detector_ ? *round_detector_ : detector_;
  return remaining_events(detector, start, end, proximity_of_rounds(), limit, execution);
}

// Detectors of rounds with a narrow phase of their own have no cache.
Events Problem::find_cached_events(const Positions& from, State& to, Execution& execution) {
  if (round_detector_) return {};
  double placing = 0;
  const auto place = [&](std::span<const Index> vertices) {
    const ScopedTimer timer(placing);
    Positions end = deformation_->surface_rows(to.controls, vertices, execution);
    flush_below_range(end);
    put_rows(to.surface, vertices, end);
    return CandidateCache::Rows{centred(rows_of(from, vertices)), centred(end)};
  };
  Events events;
  {
    const ScopedTimer timer(execution.timings.detection);
    events = candidate_cache_.find(place, proximity_of_rounds(), execution);
    excluded_.remove_from(events);
  }
  execution.timings.detection -= placing;
  execution.timings.deformation += placing;
  return events;
}

void Problem::prune_cached_candidates(const Positions& from, const Positions& to, Execution& execution) {
  if (round_detector_) return;
  const ScopedTimer timer(execution.timings.detection);
  candidate_cache_.prune(centred(from), centred(to), proximity_of_rounds(), execution);
}

std::optional<Events> Problem::remaining_events(Detector& detector, const Positions& start, const Positions& end,
                                                Proximity proximity, PairLimit limit, Execution& execution) const {
  std::optional<Events> events = limit == PairLimit::ignored
                                     ? detector.find(start, end, proximity, execution)
                                     : detector.find_within_pair_limit(start, end, proximity, execution);
  if (events) excluded_.remove_from(*events);
  return events;
}

std::optional<double> Problem::earliest_time(const Positions& from, const Positions& to, PairLimit limit,
                                             Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  const Positions start = centred(from), end = centred(to);
  if (!excluded_.empty()) {
    const auto events = remaining_events(detector_, start, end, proximity(), limit, execution);
    return events ? std::optional(first_time(*events)) : std::nullopt;
  }
  if (limit == PairLimit::ignored) return detector_.earliest_time(start, end, proximity(), execution);
  return detector_.earliest_time_within_pair_limit(start, end, proximity(), execution);
}

bool Problem::is_free(const Positions& from, const Positions& to, Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  if (excluded_.empty()) return intersections_.is_free(to, moved_vertices(from, to), execution);
  StaticPairs found = find_static_pairs(intersections_, to, execution);
  const IndexPairs all = found.faces;
  found.faces = excluded_.others(found.faces);
  if (!found.empty() || all.size() > intersections_.find(from, execution).size()) return false;
  return !depth_->is_deeper(to, all);
}

bool Problem::is_step_free(const PositionsView& from, const PositionsView& to, Execution& execution) {
  // Seen with the separation of edits, for which the boxes of what rests are at hand; but no pair needs to keep any.
  Proximity touching;
  touching.separation = proximity_.separation;
  touching.by_bodies = &no_separations_;
  return detector_.earliest_time(centred(from), centred(to), touching, execution) == never &&
         intersections_.is_free(to, moved_vertices(from, to), execution);
}

}  // namespace stiv
