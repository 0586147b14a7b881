// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/primitives.hpp"

#include <algorithm>

namespace stiv {

namespace {

std::size_t place(Index k) { return static_cast<std::size_t>(k); }

std::vector<Bounds> primitive_bounds(const CornerList& corners, const std::vector<Bounds>& vertices) {
  std::vector<Bounds> boxes;
  boxes.reserve(corners.size());
  for (const auto& [a, b, c] : corners) {
    Bounds box = vertices[place(a)];
    box.include(vertices[place(b)]);
    box.include(vertices[place(c)]);
    boxes.push_back(box);
  }
  return boxes;
}

std::vector<unsigned char> moved_primitives(const CornerList& corners, const std::vector<unsigned char>& moved) {
  std::vector<unsigned char> active;
  if (moved.empty()) return active;
  active.reserve(corners.size());
  for (const auto& [a, b, c] : corners) active.push_back(moved[place(a)] || moved[place(b)] || moved[place(c)]);
  return active;
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
  std::vector<unsigned char> used(place(surface.vertex_count()), 0);
  for (const Index vertex : surface.triangles().reshaped()) used[place(vertex)] = 1;
  for (const Index vertex : surface.loose_edges().reshaped()) used[place(vertex)] = 1;
  CornerList corners;
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (!used[place(vertex)]) corners.push_back({vertex, vertex, vertex});
  return corners;
}

std::vector<Bounds> vertex_bounds(const Positions& q) {
  std::vector<Bounds> boxes(place(static_cast<Index>(q.rows())), Bounds::empty());
  for (Index vertex = 0; vertex < q.rows(); ++vertex) boxes[place(vertex)].include(q.row(vertex).transpose(), 0);
  return boxes;
}

Primitives::Primitives(const Surface& surface, CornerList corners) : corners_(std::move(corners)) {
  for (const auto& corner : corners_) bodies_.push_back(surface.body_of(corner[0]));
}

void Primitives::update(const std::vector<Bounds>& vertices, const std::vector<unsigned char>& moved) {
  const std::vector<Bounds> boxes = primitive_bounds(corners_, vertices);
  if (!tree_) tree_.emplace(boxes, bodies_);
  tree_->refit(boxes, moved_primitives(corners_, moved));
}

}  // namespace stiv
