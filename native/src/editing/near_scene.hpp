// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "stiv/editing/obstacle.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// A surface and the triangles of obstacles near a box, as one surface. Each obstacle is a fixed body after the bodies
/// of the surface, even if none of its triangles is near.
struct NearScene {
  std::shared_ptr<const Surface> surface;
  Positions obstacles;  ///< of the last vertices of the surface
  /// Vertices and triangles of obstacles, numbered as if all obstacles followed the surface, ascending.
  std::vector<Index> obstacle_vertices, obstacle_triangles;
};

NearScene near_scene(const Surface& surface, const Obstacles& obstacles, const Eigen::AlignedBox3d& box,
                     const Execution& execution);

}  // namespace stiv
