// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "stiv/editing/obstacle.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// A surface and the triangles of obstacles near a box, as one surface. Each obstacle with such triangles is a fixed
/// body after the bodies of the surface. Time and memory do not grow with pairs of the other obstacles, which may be
/// thousands.
struct NearScene {
  std::shared_ptr<const Surface> surface;
  Positions obstacles;  ///< of the last vertices of the surface
  /// Vertices and triangles of obstacles, numbered as if all obstacles followed the surface, ascending.
  std::vector<Index> obstacle_vertices, obstacle_triangles;
  /// Bodies of obstacles, numbered in the same way, ascending.
  std::vector<Index> obstacle_bodies;

  /// The number of a triangle of the surface, as if all obstacles followed.
  Index whole_number(Index triangle) const {
    const auto own = surface->triangles().rows() - static_cast<Eigen::Index>(obstacle_triangles.size());
    return triangle < own ? triangle : obstacle_triangles[at(triangle - static_cast<Index>(own))];
  }
};

/// @param distance from the box at which triangles are still near
/// @param named bodies, numbered as if all obstacles followed the surface: an obstacle among them is always a body
NearScene near_scene(const Surface& surface, const Obstacles& obstacles, const Eigen::AlignedBox3d& box,
                     const std::vector<Index>& named, const Execution& execution, double distance = 0);

}  // namespace stiv
