// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

class Execution;

/// How a body may move during an edit. It determines which pairs can interfere.
enum class Mobility {
  fixed,      ///< never moves; not tested against fixed bodies, itself included
  rigid,      ///< keeps its shape; not tested against itself
  deformable  ///< tested against all bodies, itself included
};

/// A named part of the surface: an object.
struct Body {
  std::string name;
  Mobility mobility = Mobility::deformable;
};

/// The description of a surface.
struct SurfaceDefinition {
  Index vertex_count = 0;
  Triangles triangles;                           ///< (F, 3)
  Edges loose_edges;                             ///< (L, 2) edges of no triangle
  std::vector<Index> vertex_body;                ///< (N) body of each vertex; empty: all of body 0
  std::vector<Body> bodies;                      ///< empty: one deformable body named "surface"
  std::vector<std::pair<Index, Index>> ignored;  ///< pairs of bodies (a body with itself allowed) never tested
  std::vector<std::vector<Index>> flip_faces;    ///< vertices of polygons with triangles of several triangulations
};

/// The connectivity of all bodies in one mesh; immutable. Positions are separate.
class Surface {
 public:
  /// @throws InputError naming body, face and index: an index out of range, or a triangle or edge across bodies. A
  ///         triangle may have repeated corners.
  explicit Surface(SurfaceDefinition definition);

  const SurfaceDefinition& definition() const { return definition_; }
  Index vertex_count() const { return definition_.vertex_count; }
  const Triangles& triangles() const { return definition_.triangles; }
  const Edges& loose_edges() const { return definition_.loose_edges; }

  /// Every edge once, loose edges included, (E, 2), smaller index first, in lexicographic order.
  const Edges& edges() const { return edges_; }

  const std::vector<Body>& bodies() const { return definition_.bodies; }
  Index body_of(Index vertex) const { return definition_.vertex_body[vertex]; }
  bool is_fixed(Index vertex) const {
    return bodies()[static_cast<std::size_t>(body_of(vertex))].mobility == Mobility::fixed;
  }

  /// 1 for each body that never moves.
  std::vector<unsigned char> fixed_bodies() const;

  /// True if primitives of these two bodies are tested against each other.
  bool bodies_meet(Index a, Index b) const {
    return meets_[static_cast<std::size_t>(a) * definition_.bodies.size() + static_cast<std::size_t>(b)] != 0;
  }

  bool has_flip_faces() const { return !flip_faces_.empty(); }
  /// True if all vertices belong to one flip face. Its triangulations intersect each other and are not tested.
  template <std::size_t count>
  bool in_one_flip_face(const std::array<Index, count>& vertices) const {
    return !flip_faces_.empty() && in_one_flip_face(vertices.data(), count);
  }

  /// Neighbors of a vertex along edges, ascending.
  const Index* neighbours_begin(Index vertex) const { return neighbours_.data() + neighbour_start_[vertex]; }
  const Index* neighbours_end(Index vertex) const {
    return neighbours_.data() + neighbour_start_[static_cast<std::size_t>(vertex) + 1];
  }

  /// The first vertex of each vertex's connected component, (N).
  std::vector<Index> connected_components() const;

  /// The barycentric area of each vertex, (N), at positions q: a third of the adjacent triangles' areas. [P4, Eq. 3]
  Eigen::VectorXd vertex_areas(const PositionsView& q) const;
  /// Adds what the triangles [first, end) contribute to them, in order.
  /// @param first_row the vertex of the first row of q
  void add_vertex_areas(const PositionsView& q, Index first, Index end, Eigen::VectorXd& areas,
                        const Execution& execution, Index first_row = 0) const;

  /// The name of a vertex in messages: object "X", vertex 12, numbered within its body.
  std::string describe_vertex(Index vertex) const;
  /// Likewise for a triangle.
  std::string describe_triangle(Index triangle) const;

  /// @throws InputError naming object and vertex if the shape is not (N, 3), or a coordinate is not finite or out of
  ///         range (coordinate_range.hpp).
  void check_positions(const PositionsView& q) const;
  /// The same for the coordinates of one vertex.
  void check_position(Index vertex, const Eigen::Ref<const Eigen::RowVector3d>& position) const;

 private:
  bool in_one_flip_face(const Index* vertices, std::size_t count) const;

  SurfaceDefinition definition_;
  Edges edges_;
  std::vector<std::vector<Index>> flip_faces_;  // flip faces of each vertex, ascending; empty if there are none
  std::vector<unsigned char> meets_;
  std::vector<Index> neighbour_start_, neighbours_;
};

}  // namespace stiv
