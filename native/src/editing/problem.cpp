// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/problem.hpp"

#include "editing/validation.hpp"
#include "stiv/editing/separation.hpp"
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

/// Marks vertices whose position differs in any bit.
std::vector<unsigned char> moved_vertices(const Positions& from, const Positions& to) {
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
      rotation_rows_(deformation_->rotation_rows()),
      metric_(deformation_->metric({options_.smoothness, options_.weights})),
      detector_(surface_, {.broad_phase = options_.broad_phase}),
      intersections_(surface_) {
  check_controls(controls, "controls");
  const Positions q = deformation_->surface(controls);
  surface_->check_positions(q);
  if (q.rows() > 0) centre_ = (q.colwise().minCoeff() + q.colwise().maxCoeff()) / 2;
  const MovingExtent extent = moving_extent(*surface_, *deformation_, q);
  diagonal_ = extent.diagonal;
  const double least = least_separation(extent, controls, options_.storage, rotation_rows_);
  options_.separation = separation_in_force(options_.separation, extent, least);
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
  StartIntersections found{intersections_.find(q, execution), intersections_.find_loose_edges(q, execution),
                           intersections_.find_loose_vertices(q, execution)};
  if (found.empty()) return;
  const std::string message = describe(*surface_, found);
  throw StartIntersectsError(message, std::move(found.faces));
}

Controls Problem::stored(const Controls& controls) const { return as_stored(controls, options_.storage); }

Positions Problem::surface_at(const Controls& controls, Execution& execution) const {
  const ScopedTimer timer(execution.timings.deformation);
  return deformation_->surface(controls);
}

std::optional<Events> Problem::find_events(const Positions& from, const Positions& to, bool at_any_cost,
                                           Execution& execution) {
  const ScopedTimer timer(execution.timings.detection);
  const Positions start = centred(from), end = centred(to);
  if (at_any_cost) return detector_.find(start, end, proximity(), execution);
  return detector_.find_if_manageable(start, end, proximity(), execution);
}

std::optional<double> Problem::earliest_time(const Positions& from, const Positions& to, bool at_any_cost,
                                             Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  const Positions start = centred(from), end = centred(to);
  if (at_any_cost) return detector_.earliest_time(start, end, proximity(), execution);
  return detector_.earliest_time_if_manageable(start, end, proximity(), execution);
}

bool Problem::is_free(const Positions& from, const Positions& to, Execution& execution) {
  const ScopedTimer timer(execution.timings.acceptance);
  return intersections_.is_free(to, moved_vertices(from, to), execution);
}

}  // namespace stiv
