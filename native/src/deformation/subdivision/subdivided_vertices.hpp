// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "deformation/subdivision/cage_edges.hpp"

namespace stiv {

/// Blender's numbering of the vertices of a subdivided cage: cage vertices; inner vertices of edges, from the first end
/// to the second; inner vertices of faces. An edge has `segments` = 2^levels segments, levels >= 1.
///
/// A quad is one grid of (segments + 1)^2 points, x from corner 0 to 1, y from corner 0 to 3. Any other face with n
/// corners is n grids of (segments/2 + 1)^2 points: grid c has its origin at corner c, x along the edge to the next
/// corner, y along the edge to the previous one, and the face's center at the end of both. These grids are the "ptex
/// faces" of OpenSubdiv, in the same order. In Loop's scheme a triangle is one grid of the points with
/// x + y <= segments, x from corner 0 to 1, y from corner 0 to 2.
class SubdividedVertices {
 public:
  /// The cage and its edges must outlive this.
  /// @throws InputError when there are more vertices than an index can count.
  SubdividedVertices(const Cage& cage, const CageEdges& edges, SubdivisionScheme scheme, int levels);

  Index count() const { return face_first_.back(); }
  Index segments() const { return segments_; }

  bool has_sectors(Index face) const;            ///< a grid for each corner, around a center
  Index grid_count(Index face) const;            ///< 1, or one for each corner
  Index grid_segments(Index face) const;         ///< along each side of a grid
  Index last_in_row(Index face, Index y) const;  ///< largest x of a grid's row
  Index grid_point(Index face, Index grid, Index x, Index y) const;

  /// The k-th inner vertex of an edge counted from its first end, k in [1, segments - 1].
  Index inner_edge_point(Index edge, Index k) const { return cage_.vertex_count + edge * (segments_ - 1) + k - 1; }

 private:
  Index edge_point(Index face, Index side, Index k) const;
  Index corner_count(Index face) const;
  Index quad_point(Index face, Index x, Index y) const;
  Index triangle_point(Index face, Index x, Index y) const;
  Index sector_point(Index face, Index sector, Index x, Index y) const;

  const Cage& cage_;
  const CageEdges& edges_;
  SubdivisionScheme scheme_;
  Index segments_;
  std::vector<Index> face_first_;  ///< first inner vertex of each face; the number of all at the end
};

/// A point of the limit surface: a ptex face of OpenSubdiv and coordinates in [0, 1] in it; s + t <= 1 for a triangle
/// of Loop's scheme.
struct SurfaceLocation {
  Index ptex_face = -1;  ///< -1: on no face (a loose vertex, or on a loose edge)
  double s = 0, t = 0;
};

/// The location of each vertex of the subdivided cage, in the first of its faces, as in Blender.
std::vector<SurfaceLocation> surface_locations(const Cage& cage, const SubdividedVertices& vertices);

}  // namespace stiv
