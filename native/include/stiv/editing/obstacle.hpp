// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stiv/acceptance/least_distance.hpp"
#include "stiv/execution.hpp"
#include "stiv/surface.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// A large body that never moves, apart from the surface of a session. Sessions read only its triangles near their
/// motion, so it may have millions. Immutable; any number of sessions may share it.
///
/// Besides positions and triangles, it stores a box for each block of consecutive triangles. Neighbors should be near
/// each other in the order of triangles, as in most meshes; otherwise, blocks are large, and queries read everything.
class Obstacle {
 public:
  /// @throws InputError naming body, face or vertex: an index out of range, or a coordinate that is not finite or out
  ///         of range (coordinate_range.hpp). A triangle may have repeated corners.
  Obstacle(std::string name, Positions positions, Triangles triangles, const Execution& execution = Execution(0));

  const std::string& name() const { return name_; }
  const Positions& positions() const { return positions_; }  ///< (n, 3), world
  const Triangles& triangles() const { return triangles_; }  ///< (f, 3)

  /// Upper bound of the number of triangles near a box; reads only the boxes of blocks.
  Index count_near(const Eigen::AlignedBox3d& box) const;
  /// Triangles whose bounds are within a distance of a box, ascending; at 0, those that touch it.
  std::vector<Index> triangles_near(const Eigen::AlignedBox3d& box, const Execution& execution,
                                    double distance = 0) const;
  /// The corner of triangles that is closest to a point, if one is closer than a distance.
  std::optional<Vector3> corner_near(const Vector3& point, double distance) const;

 private:
  std::string name_;
  Positions positions_;
  Triangles triangles_;
  std::vector<Eigen::AlignedBox3d> blocks_;  ///< bounds of each block of triangles
};

/// The obstacles of a session.
using Obstacles = std::vector<std::shared_ptr<const Obstacle>>;

/// The closest pair of triangles of a surface at positions q, (N, 3), and of obstacles beside it. Only obstacles'
/// triangles near the surface are read. Triangles are numbered as if all obstacles followed the surface.
/// @throws InputError as Surface::check_positions
std::optional<NearestTriangles> least_distance(const std::shared_ptr<const Surface>& surface,
                                               const Obstacles& obstacles, const PositionsView& q, DistancePairs pairs,
                                               const Execution& execution);

}  // namespace stiv
