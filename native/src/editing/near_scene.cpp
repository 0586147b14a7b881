// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/near_scene.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace stiv {

namespace {

/// Vertices of some triangles, ascending, and their places in this list.
struct UsedVertices {
  std::vector<Index> vertices;
  Index first = 0;                    ///< vertex
  std::unique_ptr<Index[]> places{};  ///< from the first to the last vertex; of those that are not used, undefined
};

/// The least and the greatest vertex of some triangles, of which there is at least one.
std::pair<Index, Index> vertex_range(const Obstacle& obstacle, const std::vector<Index>& triangles) {
  Index first = std::numeric_limits<Index>::max(), last = 0;
  for (const Index triangle : triangles)
    for (const Index corner : obstacle.triangles().row(triangle)) {
      first = std::min(first, corner);
      last = std::max(last, corner);
    }
  return {first, last};
}

UsedVertices used_vertices(const Obstacle& obstacle, const std::vector<Index>& triangles) {
  UsedVertices used;
  if (triangles.empty()) return used;
  const auto [first, last] = vertex_range(obstacle, triangles);
  const auto count = at(last - first) + 1;
  std::vector<unsigned char> marks(count, 0);
  for (const Index triangle : triangles)
    for (const Index corner : obstacle.triangles().row(triangle)) marks[at(corner - first)] = 1;
  used.vertices.reserve(at(std::count(marks.begin(), marks.end(), 1)));
  // Written only where a vertex is used, so that the memory of the others is never touched.
  used.first = first;
  used.places.reset(new Index[count]);
  for (std::size_t k = 0; k < count; ++k) {
    if (marks[k] == 0) continue;
    used.places[k] = static_cast<Index>(used.vertices.size());
    used.vertices.push_back(first + static_cast<Index>(k));
  }
  return used;
}

/// Collects the near elements of one obstacle after the other.
class NearSceneBuilder {
 public:
  NearSceneBuilder(const Surface& surface, const Eigen::AlignedBox3d& box, double distance, const Execution& execution)
      : definition_(surface.definition()),
        box_(box),
        distance_(distance),
        execution_(execution),
        vertices_(surface.vertex_count()),
        triangles_(static_cast<Index>(surface.triangles().rows())),
        body_(static_cast<Index>(surface.bodies().size())) {}

  void add(const Obstacle& obstacle, const std::vector<Index>& named) {
    const std::vector<Index> near =
        box_.isEmpty() ? std::vector<Index>() : obstacle.triangles_near(box_, execution_, distance_);
    if (!near.empty() || std::find(named.begin(), named.end(), body_) != named.end()) append(obstacle, near);
    triangles_ += static_cast<Index>(obstacle.triangles().rows());
    vertices_ += static_cast<Index>(obstacle.positions().rows());
    ++body_;
  }

  NearScene finish() {
    scene_.surface = std::make_shared<Surface>(std::move(definition_));
    scene_.obstacles = std::move(positions_);
    return std::move(scene_);
  }

 private:
  void append(const Obstacle& obstacle, const std::vector<Index>& near) {
    const UsedVertices used = used_vertices(obstacle, near);
    append_triangles(obstacle, near, used);
    append_positions(obstacle, used.vertices);
    definition_.vertex_body.resize(at(definition_.vertex_count), static_cast<Index>(definition_.bodies.size()));
    definition_.bodies.push_back({obstacle.name(), Mobility::fixed});
    append_numbers(near, triangles_, scene_.obstacle_triangles);
    append_numbers(used.vertices, vertices_, scene_.obstacle_vertices);
    scene_.obstacle_bodies.push_back(body_);
  }

  void append_triangles(const Obstacle& obstacle, const std::vector<Index>& near, const UsedVertices& used) {
    Index row = static_cast<Index>(definition_.triangles.rows());
    definition_.triangles.conservativeResize(row + static_cast<Index>(near.size()), 3);
    for (const Index triangle : near) {
      for (Index k = 0; k < 3; ++k)
        definition_.triangles(row, k) =
            definition_.vertex_count + used.places[at(obstacle.triangles()(triangle, k) - used.first)];
      ++row;
    }
  }

  void append_positions(const Obstacle& obstacle, const std::vector<Index>& vertices) {
    const Index before = static_cast<Index>(positions_.rows()), added = static_cast<Index>(vertices.size());
    positions_.conservativeResize(before + added, 3);
    for (Index row = 0; row < added; ++row) positions_.row(before + row) = obstacle.positions().row(vertices[at(row)]);
    definition_.vertex_count += added;
  }

  /// @param first number of the obstacle's first element in the whole scene
  static void append_numbers(const std::vector<Index>& added, Index first, std::vector<Index>& numbers) {
    const std::size_t before = numbers.size();
    numbers.resize(before + added.size());
    for (std::size_t k = 0; k < added.size(); ++k) numbers[before + k] = first + added[k];
  }

  SurfaceDefinition definition_;
  const Eigen::AlignedBox3d& box_;
  double distance_;
  const Execution& execution_;
  Index vertices_, triangles_;  // of the surface and the obstacles so far
  Index body_;                  // number of the next obstacle
  Positions positions_ = Positions(0, 3);
  NearScene scene_;
};

}  // namespace

NearScene near_scene(const Surface& surface, const Obstacles& obstacles, const Eigen::AlignedBox3d& box,
                     const std::vector<Index>& named, const Execution& execution, double distance) {
  NearSceneBuilder builder(surface, box, distance, execution);
  for (const auto& obstacle : obstacles) builder.add(*obstacle, named);
  return builder.finish();
}

}  // namespace stiv
