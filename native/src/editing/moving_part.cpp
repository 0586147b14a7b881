// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/moving_part.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

void MovingPart::Range::cover(Index element) {
  if (end == 0) first = element;
  first = std::min(first, element);
  end = std::max(end, element + 1);
}

MovingPart::MovingPart(std::shared_ptr<const Surface> surface, const Positions& obstacles)
    : surface_(std::move(surface)), obstacles_(obstacles) {
  const Index rows = surface_->vertex_count() - static_cast<Index>(obstacles_.rows()),
              triangles = static_cast<Index>(surface_->triangles().rows());
  for (Index vertex = 0; vertex < rows; ++vertex)
    if (!surface_->is_fixed(vertex)) rows_.include(vertex);
  for (Index triangle = 0; triangle < triangles; ++triangle)
    if (!surface_->is_fixed(surface_->triangles()(triangle, 0))) triangles_.include(triangle);
  for (Index triangle = triangles_.first; triangle < triangles_.end; ++triangle)
    for (const Index corner : surface_->triangles().row(triangle)) corners_.cover(corner);
  rows_.first -= rows_.first % rows_of_sums;
  rows_.end = std::min(rows, (rows_.end + rows_of_sums - 1) / rows_of_sums * rows_of_sums);
}

double MovingPart::energy(const Positions& a, const Positions& b) const {
  return 0.5 * (a.middleRows(rows_.first, rows_.count()) - b.middleRows(rows_.first, rows_.count())).squaredNorm();
}

double MovingPart::longest_displacement(const Positions& from, const Positions& to) const {
  if (rows_.count() == 0) return 0;
  const auto step = to.middleRows(rows_.first, rows_.count()) - from.middleRows(rows_.first, rows_.count());
  return std::sqrt(step.rowwise().squaredNorm().maxCoeff());
}

const Eigen::VectorXd& MovingPart::region_areas(const Positions& q, const Execution& execution) const {
  const bool is_first = areas_of_rest_.size() == 0;
  if (is_first) compute_rest(q, execution);
  if (is_first || !rest_is_complete_)
    areas_ = areas_of_rest_;
  else
    areas_.segment(corners_.first, corners_.count()) = areas_of_rest_.segment(corners_.first, corners_.count());
  surface_->add_vertex_areas(q, triangles_.first, triangles_.end, areas_, execution);
  const auto moving = areas_.segment(corners_.first, corners_.count());
  if (!rest_is_complete_ || !(moving.array() > 0).all()) {
    substitute_missing_areas(areas_);
    rest_is_complete_ = false;  // the next call begins with what is missing
  }
  return areas_;
}

/// Of the first vertices; the triangles of obstacles follow.
Index MovingPart::count_of_triangles(Index vertices) const {
  const auto triangles = surface_->triangles().col(0);
  auto count = static_cast<Index>(triangles.size());
  while (obstacles_.rows() > 0 && count > triangles_.end && triangles[count - 1] >= vertices) --count;
  return count;
}

/// Areas that the triangles of the other part give to all vertices.
void MovingPart::compute_rest(const Positions& q, const Execution& execution) const {
  areas_of_rest_ = Eigen::VectorXd::Zero(surface_->vertex_count());
  const auto own_vertices = static_cast<Index>(q.rows()), own = count_of_triangles(own_vertices);
  surface_->add_vertex_areas(q, 0, triangles_.first, areas_of_rest_, execution);
  surface_->add_vertex_areas(q, triangles_.end, own, areas_of_rest_, execution);
  const auto all = static_cast<Index>(surface_->triangles().rows());
  surface_->add_vertex_areas(obstacles_, own, all, areas_of_rest_, execution, own_vertices);
  rest_is_complete_ = (areas_of_rest_.head(corners_.first).array() > 0).all() &&
                      (areas_of_rest_.tail(areas_of_rest_.size() - corners_.end).array() > 0).all();
}

}  // namespace stiv
