// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "stiv/editing/obstacle.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Bounds of the vertices whose bodies may move.
Eigen::AlignedBox3d moving_bounds(const Surface& surface, const PositionsView& q);

/// A box around these bounds. It is larger by their diagonal, or by less if many triangles of obstacles would be near.
/// With a motion, it is larger by a part of that on all sides, and by more along the motion.
/// @param motion displacement of the bounds in a call; only its direction counts
Eigen::AlignedBox3d box_around(const Eigen::AlignedBox3d& bounds, const Vector3& motion, const Obstacles& obstacles,
                               Index moving_triangles);

/// Are these bounds inside a box by this margin, or empty?
bool contains(const Eigen::AlignedBox3d& box, const Eigen::AlignedBox3d& bounds, double margin);

Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& bounds, double margin);
Eigen::AlignedBox3d whole_space();

}  // namespace stiv
