// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/primitives.hpp"

#include <algorithm>
#include <utility>

namespace stiv {

namespace {

constexpr Index chunk_size = 4096;

/// The sum of the corners' boxes, scaled so that it does not overflow.
NumberedPoint centre_of(const std::array<Index, 3>& corners, std::span<const PackedBox> vertices, Index number) {
  NumberedPoint centre{{0, 0, 0}, number};
  for (const Index corner : corners) {
    const auto& values = vertices[at(corner)].values;
    for (std::size_t axis = 0; axis < 3; ++axis) centre.position[axis] += (values[axis] - values[axis + 3]) / 8;
  }
  return centre;
}

}  // namespace

CornerList triangle_corners(const Surface& surface) {
  static_assert(sizeof(CornerList::value_type) == 3 * sizeof(Index));
  CornerList corners(at(surface.triangles().rows()));
  const Index* const first = surface.triangles().data();
  if (!corners.empty()) std::copy(first, first + surface.triangles().size(), corners[0].data());
  return corners;
}

CornerList loose_edge_corners(const Surface& surface) {
  CornerList corners;
  for (const auto& row : surface.loose_edges().rowwise()) corners.push_back({row[0], row[1], row[1]});
  return corners;
}

CornerList loose_vertex_corners(const Surface& surface) {
  std::vector<unsigned char> used(at(surface.vertex_count()), 0);
  for (const Index vertex : surface.triangles().reshaped<Eigen::RowMajor>()) used[at(vertex)] = 1;
  for (const Index vertex : surface.loose_edges().reshaped<Eigen::RowMajor>()) used[at(vertex)] = 1;
  CornerList corners;
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (!used[at(vertex)]) corners.push_back({vertex, vertex, vertex});
  return corners;
}

Primitives::Primitives(const Surface& surface, CornerList corners)
    : corners_(std::move(corners)), at_rest_(surface.fixed_bodies()), changed_(surface.bodies().size(), 1) {
  bodies_.reserve(corners_.size());
  for (const auto& corner : corners_) bodies_.push_back(surface.body_of(corner[0]));
}

void Primitives::note_changes(const std::vector<unsigned char>& bodies) {
  for (std::size_t body = 0; body < bodies.size(); ++body) changed_[body] |= bodies[body];
}

void Primitives::update(std::span<const PackedBox> vertices, const Execution& execution) {
  if (!tree_) {
    NumberedPoints centres(corners_.size());
    execution.for_chunks(static_cast<Index>(corners_.size()), chunk_size, [&](Index begin, Index end, Index) {
      for (Index k = begin; k < end; ++k) centres[at(k)] = centre_of(corners(k), vertices, k);
    });
    tree_.emplace(std::move(centres), PrimitiveGroups(bodies_, at_rest_), CornerRows(), execution);
    static_assert(sizeof(corners_[0]) == 3 * sizeof(Index));
    block_corners_ = tree_->block_corners({corners_.empty() ? nullptr : corners_[0].data(), 3});
  }
  tree_->refit_groups_corners(changed_, block_corners_, vertices, execution);
  std::fill(changed_.begin(), changed_.end(), 0);
}

// The tree skips pairs of primitives with equal corner names. Those at rest need none: no pair among them is compared.
// Corners whose star is not proven free get unique negative names.
void Primitives::leave_out_neighbours(const std::vector<unsigned char>& free_stars,
                                      const std::vector<unsigned char>& changed, const Execution& execution) {
  std::vector<unsigned char> named = changed;
  for (std::size_t body = 0; body < named.size(); ++body)
    named[body] &= static_cast<unsigned char>(at_rest_[body] == 0);
  names_.resize(3 * corners_.size());
  execution.for_chunks(static_cast<Index>(corners_.size()), chunk_size, [&](Index begin, Index end, Index) {
    for (Index primitive = begin; primitive < end; ++primitive) {
      if (named[at(bodies_[at(primitive)])] == 0) continue;
      for (Index k = 3 * primitive; k < 3 * (primitive + 1); ++k) {
        const Index vertex = corners_[at(primitive)][at(k % 3)];
        names_[at(k)] = free_stars[at(vertex)] ? vertex : -2 - k;
      }
    }
  });
  tree_->set_corners({names_.data(), 3}, named, execution);
}

}  // namespace stiv
