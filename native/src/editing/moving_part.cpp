// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/moving_part.hpp"

#include <algorithm>
#include <utility>

#include "editing/scene_rows.hpp"
#include "stiv/volumes/relative.hpp"

namespace stiv {

namespace {

// Eigen adds in interleaved sums, at most 16. From a multiple of this row on, zeros before and after change none of
// them.
constexpr Index rows_of_sums = 16;

}  // namespace

void MovingPart::Range::include(Index element) {
  if (end == 0) first = element;
  end = element + 1;
}

MovingPart::MovingPart(std::shared_ptr<const Surface> surface, const Positions& obstacles)
    : surface_(std::move(surface)), obstacles_(obstacles) {
  const Index rows = surface_->vertex_count() - static_cast<Index>(obstacles_.rows()),
              triangles = static_cast<Index>(surface_->triangles().rows());
  for (Index vertex = 0; vertex < rows; ++vertex)
    if (!surface_->is_fixed(vertex)) rows_.include(vertex);
  for (Index triangle = 0; triangle < triangles; ++triangle)
    if (!surface_->is_fixed(surface_->triangles()(triangle, 0))) triangles_.include(triangle);
  rows_.first -= rows_.first % rows_of_sums;
  rows_.end = std::min(rows, (rows_.end + rows_of_sums - 1) / rows_of_sums * rows_of_sums);
}

double MovingPart::energy(const Positions& a, const Positions& b) const {
  return 0.5 * (a.middleRows(rows_.first, rows_.count()) - b.middleRows(rows_.first, rows_.count())).squaredNorm();
}

double MovingPart::longest_displacement(const Positions& from, const Positions& to) const {
  if (rows_.count() == 0) return 0;
  const auto step = to.middleRows(rows_.first, rows_.count()) - from.middleRows(rows_.first, rows_.count());
  return step.rowwise().norm().maxCoeff();
}

Eigen::VectorXd MovingPart::region_areas(const Positions& q) const {
  if (areas_of_rest_.size() == 0) {
    areas_of_rest_ = Eigen::VectorXd::Zero(surface_->vertex_count());
    SceneRows rows(obstacles_);
    const Positions& whole = rows.with_rest(q);
    surface_->add_vertex_areas(whole, 0, triangles_.first, areas_of_rest_);
    surface_->add_vertex_areas(whole, triangles_.end, static_cast<Index>(surface_->triangles().rows()), areas_of_rest_);
  }
  Eigen::VectorXd areas = areas_of_rest_;
  surface_->add_vertex_areas(q, triangles_.first, triangles_.end, areas);
  substitute_missing_areas(areas);
  return areas;
}

}  // namespace stiv
