// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/edit_context.hpp"

#include <algorithm>

#include "editing/effective_separation.hpp"
#include "editing/large_body.hpp"
#include "editing/validation.hpp"
#include "stiv/coordinate_range.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

std::shared_ptr<const Surface> checked(std::shared_ptr<const Surface> surface, const Positions& obstacles,
                                       const std::shared_ptr<const Deformation>& deformation) {
  if (!surface || !deformation) throw InputError("a surface and a deformation are needed");
  check_fit(*surface, *deformation, static_cast<Index>(obstacles.rows()));
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

/// Rotation vectors without pinned coordinates: composing rotations would change those.
std::vector<Index> free_rotation_rows(const Deformation& deformation, const Eigen::VectorXd& weights) {
  std::vector<Index> rows = deformation.rotation_rows();
  if (weights.size() == 0 || weights.size() == deformation.control_count()) return rows;
  std::erase_if(rows, [&](Index row) { return (weights.segment<3>(3 * row).array() == 0).any(); });
  return rows;
}

/// Rows of the controls that are angles or other scalars, ascending.
std::vector<Index> rows_without_length(const Deformation& deformation) {
  std::vector<Index> rows = deformation.rotation_rows();
  for (const Index row : deformation.scalar_rows().rows) rows.push_back(row);
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace

EditContext::EditContext(std::shared_ptr<const Surface> surface, Positions obstacles,
                         std::shared_ptr<const Deformation> deformation, const Controls& start, EditOptions options,
                         const Execution& execution)
    : surface_(checked(std::move(surface), obstacles, deformation)),
      obstacles_(std::move(obstacles)),
      moving_part_(surface_, obstacles_),
      deformation_(std::move(deformation)),
      options_(checked(std::move(options), deformation_->control_count())),
      limits_(deformation_->scalar_rows(), options_.storage),
      rotation_rows_(free_rotation_rows(*deformation_, options_.weights)),
      revision_(deformation_->revision()),
      metric_(metric_of(*deformation_, options_)) {
  check_overlapping(*surface_, options_.overlapping);
  check_touching(*surface_, options_.touching);
  check_controls(start, "controls");
  const Positions q = deformation_->surface_in_range(start, execution);
  check_positions(q, execution);
  if (q.rows() > 0) centre_ = (q.colwise().minCoeff() + q.colwise().maxCoeff()) / 2;
  centred_obstacles_ = obstacles_;
  centre(centred_obstacles_);
  SceneRows rows(centred_obstacles_);
  centred(q, rows, execution);
  reference_ = std::move(rows.with_room_for(static_cast<Index>(q.rows())));
  set_proximity(q, start);
  large_body_edge_ = mean_edge_of_large_bodies(*surface_, q);
}

void EditContext::set_proximity(const Positions& start, const Controls& controls) {
  const MovingExtent extent = moving_extent(*surface_, *deformation_, start);
  diagonal_ = extent.diagonal;
  least_separation_ = stiv::least_separation(extent, controls, options_.storage, rows_without_length(*deformation_));
  const std::vector<BodyPairSeparation>& pairs = options_.pair_separations;
  const bool may_touch = options_.volumes != VolumeKind::relative && options_.separation == 0 && pairs.empty();
  options_.separation =
      may_touch ? least_separation_ : effective_separation(options_.separation, extent, least_separation_);
  proximity_ = {options_.separation, options_.min_clearance_ratio, nullptr, &reference_,
                options_.min_clearance_ratio_between};
  if (!pairs.empty()) {
    body_separations_ = body_separations(*surface_, pairs, options_.separation, extent, least_separation_);
    proximity_.separation = body_separations_->largest();
    proximity_.by_bodies = &*body_separations_;
  }
  if (!options_.overlapping.empty()) {  // a pair may have started at distance 0
    overlapping_.emplace(surface_->bodies().size());
    for (const auto& [a, b] : options_.overlapping) overlapping_->insert(a, b);
    proximity_.without_reference = &*overlapping_;
  }
  round_proximity_ = proximity_;
  if (may_touch) round_proximity_.separation = 0;
}

void EditContext::set_weights(Eigen::VectorXd weights, std::vector<Eigen::Matrix3d> weight_axes) {
  EditOptions changed = options_;
  changed.weights = std::move(weights);
  changed.weight_axes = std::move(weight_axes);
  check_options(changed, deformation_->control_count());
  const std::uint64_t revision = deformation_->revision();
  metric_ = metric_of(*deformation_, changed);
  revision_ = revision;
  rotation_rows_ = free_rotation_rows(*deformation_, changed.weights);
  options_ = std::move(changed);
  tight_metrics_ = {};
}

const Metric& EditContext::tight_metric(int level) const {
  std::unique_ptr<Metric>& metric = tight_metrics_[static_cast<std::size_t>(level)];
  if (!metric) {
    constexpr std::array<double, tight_levels> divisors{10, 100, 1000};
    metric = deformation_->metric(
        {options_.smoothness / divisors[static_cast<std::size_t>(level)], options_.weights, options_.weight_axes});
  }
  return *metric;
}

bool EditContext::renew_metric() {
  const std::uint64_t revision = deformation_->revision();
  if (revision == revision_) return false;
  metric_ = metric_of(*deformation_, options_);
  tight_metrics_ = {};
  revision_ = revision;
  return true;
}

void EditContext::check_controls(const Controls& controls, const char* name) const {
  const Index count = deformation_->control_count();
  if (controls.rows() != count)
    throw InputError(std::string(name) + " has shape (" + std::to_string(controls.rows()) +
                     ", 3), the deformation needs (" + std::to_string(count) + ", 3)");
  for (Index row = 0; row < count; ++row)
    if (!controls.row(row).allFinite())
      throw InputError(std::string(name) + ": " + describe_control(*surface_, *deformation_, row) +
                       ": coordinate is not finite");
  stored(controls);  // throws if single precision cannot represent it
}

Positions EditContext::surface_at(const Controls& controls, Execution& execution) const {
  const ScopedTimer timer(execution.timings.deformation);
  return deformation_->surface_in_range(controls, execution);
}

void EditContext::centre(PositionRows q) const {
  q.rowwise() -= centre_;
  flush_below_range(q);
}

const Positions& EditContext::centred(const PositionsView& q, SceneRows& rows, const Execution& execution) const {
  constexpr Index rows_per_chunk = 2048;
  Positions& about_centre = rows.with_room_for(static_cast<Index>(q.rows()));
  execution.for_chunks(static_cast<Index>(q.rows()), rows_per_chunk, [&](Index begin, Index end, Index) {
    about_centre.middleRows(begin, end - begin) = q.middleRows(begin, end - begin);
    centre(about_centre.middleRows(begin, end - begin));
  });
  return about_centre;
}

void EditContext::check_positions(const PositionsView& q, const Execution& execution) const {
  constexpr Index rows_per_chunk = 4096;
  if (q.rows() + obstacles_.rows() != surface_->vertex_count()) return surface_->check_positions(q);
  execution.for_chunks(static_cast<Index>(q.rows()), rows_per_chunk, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex) surface_->check_position(vertex, q.row(vertex));
  });
}

}  // namespace stiv
