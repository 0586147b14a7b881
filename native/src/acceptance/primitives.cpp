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
  if (!tree_) tree_.emplace(centres_of(boxes), bodies_);
  tree_->refit(boxes, moved_primitives(corners_, moved));
}

// The tree leaves out primitives with a corner of one name. Where their star is not known to be free, corners get names
// that no other has: negative numbers.
void Primitives::leave_out_neighbours(const std::vector<unsigned char>& free_stars) {
  names_.resize(3 * corners_.size());
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const Index vertex = corners_[k / 3][k % 3];
    names_[k] = free_stars[place(vertex)] ? vertex : -2 - static_cast<Index>(k);
  }
  tree_->set_corners({names_.data(), 3});
}

}  // namespace stiv
