// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// What a body may do during an edit, which decides the pairs that can interfere at all.
enum class Mobility {
  fixed,      ///< never moves; two fixed bodies are not tested against each other, nor is one against itself
  rigid,      ///< keeps its shape; not tested against itself
  deformable  ///< tested against everything, itself included
};

/// A part of the surface that the user knows by name: an object.
struct Body {
  std::string name;
  Mobility mobility = Mobility::deformable;
};

/// Plain description of a surface, to be validated.
struct SurfaceDefinition {
  Index vertex_count = 0;
  Triangles triangles;             ///< (F, 3)
  Edges loose_edges;               ///< (L, 2) edges of no triangle; they meet edges, their ends meet faces
  std::vector<Index> vertex_body;  ///< (N) body of each vertex; empty: all of body 0
  std::vector<Body> bodies;        ///< empty: one deformable body named "surface"
  std::vector<std::pair<Index, Index>> ignored;  ///< pairs of bodies (a body with itself allowed) never tested
  std::vector<std::vector<Index>> recut_faces;   ///< vertices of polygons whose triangles come in more than one cut
};

/// All triangles of all taking part, one concatenated mesh: connectivity only, immutable. Positions travel apart.
class Surface {
 public:
  /// @throws InputError naming body, face and index: indices out of range, a triangle or edge across bodies,
  ///         a body index out of range. Repeated corners within a triangle are allowed (a degenerate face).
  explicit Surface(SurfaceDefinition definition);

  Index vertex_count() const { return definition_.vertex_count; }
  const Triangles& triangles() const { return definition_.triangles; }
  const Edges& loose_edges() const { return definition_.loose_edges; }

  /// Every edge once, (E, 2), smaller index first, in lexicographic order; loose edges included, zero-length repeated
  /// corners left out.
  const Edges& edges() const { return edges_; }

  const std::vector<Body>& bodies() const { return definition_.bodies; }
  Index body_of(Index vertex) const { return definition_.vertex_body[vertex]; }

  /// May primitives of these two bodies interfere?
  bool bodies_meet(Index a, Index b) const {
    return meets_[static_cast<std::size_t>(a) * definition_.bodies.size() + static_cast<std::size_t>(b)] != 0;
  }

  bool has_recut_faces() const { return !recut_.empty(); }
  /// Do all these vertices belong to one recut face? Its cuts cross each other by nature, so they are not tested.
  template <std::size_t count>
  bool in_one_recut_face(const std::array<Index, count>& vertices) const {
    return !recut_.empty() && in_one_recut_face(vertices.data(), count);
  }

  /// Neighbours of a vertex along edges, ascending.
  const Index* neighbours_begin(Index vertex) const { return neighbours_.data() + neighbour_start_[vertex]; }
  const Index* neighbours_end(Index vertex) const {
    return neighbours_.data() + neighbour_start_[static_cast<std::size_t>(vertex) + 1];
  }

  /// Barycentric area of each vertex: a third of the adjacent triangles' areas at positions `q`, (N). [P4, Eq. 3]
  Eigen::VectorXd vertex_areas(const PositionsView& q) const;

  /// "object "X", vertex 12": how messages name a vertex (12 counted within its body).
  std::string describe_vertex(Index vertex) const;
  /// Likewise for a triangle.
  std::string describe_triangle(Index triangle) const;

  /// @throws InputError naming object and vertex if the shape is not (N, 3), or a coordinate is not finite or out of
  ///         range (coordinate_range.hpp).
  void check_positions(const PositionsView& q) const;
  /// The same for the coordinates of one vertex.
  void check_position(Index vertex, const Eigen::Ref<const Eigen::RowVector3d>& position) const;

 private:
  bool in_one_recut_face(const Index* vertices, std::size_t count) const;

  SurfaceDefinition definition_;
  Edges edges_;
  std::vector<std::vector<Index>> recut_;  // recut faces of each vertex, ascending; empty without any
  std::vector<unsigned char> meets_;
  std::vector<Index> neighbour_start_, neighbours_;
};

}  // namespace stiv
