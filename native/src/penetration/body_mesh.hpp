// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "acceptance/intersection/exact_intersection.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The mesh of some triangles of a body, with vertices numbered from 0, so that its cost does not depend on other
/// bodies.
struct BodyMesh {
  std::vector<Index> vertices;                ///< of the surface, ascending
  std::vector<Index> triangles;               ///< of the surface, ascending
  std::vector<std::array<Index, 3>> corners;  ///< of each triangle, as positions in `vertices`
  std::vector<Index> seeds;                   ///< one vertex of each connected component
  std::vector<std::array<Index, 2>> walk;     ///< edges (from, to) of a spanning forest, starting at the seeds
};

/// @param triangles of the surface, ascending
BodyMesh body_mesh(const Surface& surface, std::vector<Index> triangles);

/// A body at given positions. Refers to its mesh.
class PlacedBody {
 public:
  /// @param q (N, 3) positions of the whole surface
  PlacedBody(const BodyMesh& mesh, const PositionsView& q);

  const BodyMesh& mesh() const { return mesh_; }
  Index triangle_count() const { return static_cast<Index>(mesh_.triangles.size()); }
  const std::array<Index, 3>& corners(Index triangle) const { return mesh_.corners[at(triangle)]; }
  const Vector3& point(Index vertex) const { return points_[at(vertex)]; }
  Triangle triangle(Index triangle) const;
  const Eigen::AlignedBox3d& box() const { return box_; }

  /// The normal of a triangle; its length is twice the area.
  Vector3 area_vector(Index triangle) const;

  /// The volume of a closed body, negative if it faces inward.
  double signed_volume() const;

 private:
  const BodyMesh& mesh_;
  std::vector<Vector3> points_;
  Eigen::AlignedBox3d box_;
};

}  // namespace stiv
