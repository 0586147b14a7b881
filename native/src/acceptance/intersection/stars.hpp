// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

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
  Stars(const std::vector<std::array<Index, 3>>& triangles, Index vertex_count);

  /// Sets 1 for each vertex whose star is proven free; 0 is inconclusive. Vertices of bodies without changes keep what
  /// they have. Returns whether any vertex got another value.
  /// @param moved as in IntersectionTest::is_free; stars without a moved vertex are skipped and get 0
  bool find_free(const PlacedVertices& placed, const std::vector<unsigned char>& moved,
                 std::vector<unsigned char>& free, const Execution& execution) const;

 private:
  /// The link of a vertex, in order: triangle k is (vertex, link[k], link[k + 1]). The last vertex of a closed link is
  /// its first. Empty unless the triangles are a single fan of two to StarBlock::most_triangles triangles.
  std::span<const Index> link(Index vertex) const;

  /// The number of triangles, and whether the star is closed.
  std::pair<std::size_t, bool> shape(Index vertex) const;

  std::vector<Index> start_;  // of each link, (N + 1)
  std::vector<Index> links_;
  std::vector<Index> stars_;  // vertices with a link, sorted by shape
};

}  // namespace stiv
