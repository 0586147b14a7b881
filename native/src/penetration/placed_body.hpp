// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "acceptance/intersection/exact_meeting.hpp"
#include "penetration/body_mesh.hpp"

namespace stiv {

/// A body where it stands. Keeps the mesh by reference.
class PlacedBody {
 public:
  /// @param q (N, 3), of the whole surface
  PlacedBody(const BodyMesh& mesh, const Positions& q);

  const BodyMesh& mesh() const { return mesh_; }
  Index triangle_count() const { return static_cast<Index>(mesh_.triangles.size()); }
  const std::array<Index, 3>& corners(Index triangle) const { return mesh_.corners[at(triangle)]; }
  const Vector3& point(Index vertex) const { return points_[at(vertex)]; }
  Triangle triangle(Index triangle) const;
  const Eigen::AlignedBox3d& box() const { return box_; }

  /// Twice the area of a triangle, along its normal.
  Vector3 area_vector(Index triangle) const;

  /// Of a closed body; negative if it faces inward.
  double signed_volume() const;

 private:
  const BodyMesh& mesh_;
  std::vector<Vector3> points_;
  Eigen::AlignedBox3d box_;
};

}  // namespace stiv
