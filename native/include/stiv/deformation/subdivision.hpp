// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/linear.hpp"
#include "stiv/types.hpp"

namespace stiv {

enum class SubdivisionScheme {
  catmull_clark,  ///< polygons, as Blender's Subdivision Surface modifier
  loop            ///< triangles only [Loop 1987]; the same rules for creases and boundaries
};

enum class BoundarySmoothing {
  all,              ///< boundaries are smoothed, corners too
  preserve_corners  ///< corners of the boundary stay sharp
};

struct SubdivisionOptions {
  int levels = 1;             ///< 0..11, as in Blender; an edge becomes 2^levels edges
  bool limit_surface = true;  ///< vertices on the limit surface, adaptive refinement to `quality`
  int quality = 3;            ///< 1..10, the modifier's own value; used with limit_surface
  bool simple = false;        ///< the modifier's "Simple" type: no smoothing
  BoundarySmoothing boundary = BoundarySmoothing::all;
  SubdivisionScheme scheme = SubdivisionScheme::catmull_clark;
};

/// A polygon cage. The order of its edges and faces determines the order of the result's vertices. A face has at least
/// three corners.
struct Cage {
  Index vertex_count = 0;
  Edges edges;                       ///< (E, 2) all edges, loose ones included, directions as stored
  std::vector<Index> face_corners;   ///< corners of all faces, in sequence
  std::vector<Index> face_starts;    ///< (F + 1) first corner of each face
  std::vector<float> edge_crease;    ///< (E) in [0, 1], or empty
  std::vector<float> vertex_crease;  ///< (V) in [0, 1], or empty
};

/// Weights of the cage's vertices for the vertices of the subdivided mesh, in Blender's order: cage vertices, inner
/// vertices of edges, inner vertices of faces. Uses OpenSubdiv with sharpness = 10 crease^2, as Blender does.
/// @throws InputError naming face or edge: fewer than 3 corners or a repeated one, an index out of range, a missing
/// edge,
///         a crease out of [0, 1], levels or quality out of range, or a face with more than 3 corners for Loop's scheme
WeightMatrix subdivision_weights(const Cage& cage, const SubdivisionOptions& options);

/// Corner indices of quads, (Q, 4).
using Quads = Eigen::Matrix<Index, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// The faces of the mesh subdivided by Catmull-Clark, all quads, in the vertex order of `subdivision_weights`, with the
/// orientation and in the order of the cage's faces.
/// @param levels 1..11
/// @throws InputError as `subdivision_weights`
Quads subdivided_faces(const Cage& cage, int levels);

/// The faces of the mesh subdivided by Loop's scheme, all triangles; otherwise as `subdivided_faces`.
Triangles subdivided_triangles(const Cage& cage, int levels);

}  // namespace stiv
