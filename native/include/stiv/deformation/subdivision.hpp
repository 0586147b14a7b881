// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/linear.hpp"
#include "stiv/types.hpp"

namespace stiv {

enum class SubdivisionScheme {
  catmull_clark,  ///< polygons, as Blender's Subdivision Surface modifier does it
  loop            ///< triangles alone [Loop 1987]; creases and boundaries by the same rules
};

enum class BoundarySmoothing {
  all,              ///< boundaries are smoothed, corners too
  preserve_corners  ///< corners of the boundary stay sharp
};

struct SubdivisionOptions {
  int levels = 1;             ///< 0..6; an edge is cut into 2^levels, 0 leaves the cage as it is
  bool limit_surface = true;  ///< vertices on the limit surface, adaptive refinement to `quality`
  int quality = 3;            ///< 1..10, the modifier's own value; used with limit_surface
  bool simple = false;        ///< the modifier's "Simple" type: no smoothing
  BoundarySmoothing boundary = BoundarySmoothing::all;
  SubdivisionScheme scheme = SubdivisionScheme::catmull_clark;
};

/// A polygon cage: vertices by number, edges and faces in their own order, both of which fix the vertex order of the
/// result; faces may have any number of corners from 3.
struct Cage {
  Index vertex_count = 0;
  Edges edges;                       ///< (E, 2), all of them, loose ones included, directions as stored
  std::vector<Index> face_corners;   ///< corners of all faces, one after the other
  std::vector<Index> face_starts;    ///< (F + 1) first corner of each face
  std::vector<float> edge_crease;    ///< (E) in [0, 1], or empty
  std::vector<float> vertex_crease;  ///< (V) in [0, 1], or empty
};

/// Weights of the cage's vertices in the vertices of the subdivided mesh, in the order Blender gives them:
/// cage vertices, inner vertices of edges, inner vertices of faces. (BLENDER: OpenSubdiv Far; sharpness = 10 crease^2.)
/// @throws InputError naming face or edge: fewer than 3 corners or one twice, index out of range, an edge missing from
///         the list, crease out of [0, 1], levels or quality out of range, Loop's scheme on a face of more than 3.
WeightMatrix subdivision_weights(const Cage& cage, const SubdivisionOptions& options);

/// Corner indices of quads, (Q, 4).
using Quads = Eigen::Matrix<Index, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// The faces of the mesh by Catmull and Clark, all quads, in the vertex order of `subdivision_weights` and with the
/// orientation of the cage's faces; those of a cage face stand together.
/// @param levels 1..6
/// @throws InputError as `subdivision_weights`
Quads subdivided_faces(const Cage& cage, int levels);

/// The faces of the mesh by Loop, all triangles: otherwise as `subdivided_faces`.
Triangles subdivided_triangles(const Cage& cage, int levels);

}  // namespace stiv
