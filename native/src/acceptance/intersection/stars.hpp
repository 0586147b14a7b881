// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "acceptance/intersection/near_pairs.hpp"
#include "acceptance/intersection/placed_vertices.hpp"

namespace stiv {

/// Proves for single vertices that their star is free: the triangles around the vertex share only common corners and
/// edges. A star is free if, seen along some direction, all its triangles face that direction and turn around the
/// vertex at most once. (mathematics.md, "Stars")
///
/// On a smooth surface every star is free, so no pair of neighbors needs a test.
class Stars {
 public:
  /// @param triangles (F, 3) corners, which may repeat
  Stars(std::span<const std::array<Index, 3>> triangles, Index vertex_count);

  /// The result of a proof for one star.
  enum Proof : unsigned char { inconclusive, free_here, free_within_reach };

  /// Sets the proof of each vertex's star. Vertices of bodies without changes keep what they have.
  /// @param moved as in IntersectionTest::is_free; stars without a moved vertex are skipped and inconclusive
  /// @param reach that each coordinate may differ; 0: no star is free within reach
  void find_free(const PlacedVertices& placed, const std::vector<unsigned char>& moved, double reach,
                 std::vector<unsigned char>& proofs, const Execution& execution) const;

  /// The vertices of stars with a vertex marked in `moved` (empty: all) that are not free within the reach.
  std::vector<Index> find_open(const std::vector<unsigned char>& proofs, const std::vector<unsigned char>& moved) const;

  /// Does the star of a vertex with a link have a vertex marked in `moved` (empty: all)?
  bool has_moved(Index vertex, const std::vector<unsigned char>& moved) const;

  /// Those of some vertices with a link whose star is not proven free at other points.
  std::vector<Index> find_unproven(std::span<const Index> vertices, const PackedPoints& points,
                                   const Execution& execution) const;

  /// The link of a vertex, in order: triangle k is (vertex, link[k], link[k + 1]). The last vertex of a closed link is
  /// its first. Empty unless the triangles are a single fan of two to StarBlock::most_triangles triangles with three
  /// different corners each.
  std::span<const Index> link(Index vertex) const;

  /// Does `holds` return true for a pair of triangles in the star of a vertex with a link?
  template <class Predicate>
  bool any_pair(Index vertex, const Predicate& holds) const {
    const std::span<const Index> around = link(vertex);
    for (std::size_t a = 1; a < around.size(); ++a)
      for (std::size_t b = 1; b < a; ++b)
        if (holds(CornerPair{{vertex, around[a - 1], around[a]}, {vertex, around[b - 1], around[b]}})) return true;
    return false;
  }

 private:
  /// Sets `proof` for each of some stars that is proven, unless `skips(vertex)`.
  template <class Skip>
  void prove(std::span<const Index> stars, const PackedPoints& points, double reach, Proof proof, const Skip& skips,
             std::vector<unsigned char>& proofs, const Execution& execution) const;

  /// The number of triangles, and whether the star is closed.
  std::pair<std::size_t, bool> shape(Index vertex) const;

  std::vector<Index> start_;  // of each link, (N + 1)
  std::vector<Index> links_;
  std::vector<Index> stars_;  // vertices with a link, sorted by shape
};

}  // namespace stiv
