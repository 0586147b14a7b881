// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/primitives.hpp"

#include <algorithm>

namespace stiv {

namespace {

constexpr Index chunk_size = 4096;

PackedBox box_of(const std::array<Index, 3>& corners, const std::vector<PackedBox>& vertices) {
  PackedBox box = vertices[at(corners[0])];
  box.include(vertices[at(corners[1])]);
  box.include(vertices[at(corners[2])]);
  return box;
}

}  // namespace

CornerList triangle_corners(const Surface& surface) {
  CornerList corners;
  for (const auto& row : surface.triangles().rowwise()) corners.push_back({row[0], row[1], row[2]});
  return corners;
}

CornerList loose_edge_corners(const Surface& surface) {
  CornerList corners;
  for (const auto& row : surface.loose_edges().rowwise()) corners.push_back({row[0], row[1], row[1]});
  return corners;
}

CornerList loose_vertex_corners(const Surface& surface) {
  std::vector<unsigned char> used(at(surface.vertex_count()), 0);
  for (const Index vertex : surface.triangles().reshaped()) used[at(vertex)] = 1;
  for (const Index vertex : surface.loose_edges().reshaped()) used[at(vertex)] = 1;
  CornerList corners;
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (!used[at(vertex)]) corners.push_back({vertex, vertex, vertex});
  return corners;
}

std::vector<PackedBox> vertex_boxes(const PositionsView& q, const std::vector<unsigned char>& moved,
                                    const Execution& execution) {
  const auto count = static_cast<Index>(q.rows());
  std::vector<PackedBox> boxes(at(count));
  execution.for_chunks(count, chunk_size, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex) {
      Bounds point = Bounds::empty();
      point.include(q.row(vertex).transpose(), 0);
      boxes[at(vertex)] = PackedBox::of(point, moved.empty() || moved[at(vertex)] != 0);
    }
  });
  return boxes;
}

Primitives::Primitives(const Surface& surface, CornerList corners) : corners_(std::move(corners)) {
  for (const auto& corner : corners_) bodies_.push_back(surface.body_of(corner[0]));
}

void Primitives::update(const std::vector<PackedBox>& vertices, const Execution& execution) {
  if (!tree_) {
    std::vector<Bounds> boxes;
    for (const auto& corners : corners_) boxes.push_back(box_of(corners, vertices).bounds());
    tree_.emplace(centres_of(boxes), bodies_, CornerRows(), execution);
  }
  tree_->refit([&](Index primitive) { return box_of(corners(primitive), vertices); }, execution);
}

// The tree skips pairs of primitives with equal corner names. Corners whose star is not proven free get unique negative
// names.
void Primitives::leave_out_neighbours(const std::vector<unsigned char>& free_stars, const Execution& execution) {
  names_.resize(3 * corners_.size());
  execution.for_chunks(static_cast<Index>(corners_.size()), chunk_size, [&](Index begin, Index end, Index) {
    for (Index k = 3 * begin; k < 3 * end; ++k) {
      const Index vertex = corners_[at(k / 3)][at(k % 3)];
      names_[at(k)] = free_stars[at(vertex)] ? vertex : -2 - k;
    }
  });
  tree_->set_corners({names_.data(), 3}, execution);
}

}  // namespace stiv
