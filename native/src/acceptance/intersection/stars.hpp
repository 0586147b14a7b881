// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "acceptance/intersection/point_rows.hpp"

namespace stiv {

/// Proofs, vertex by vertex, that the triangles around a vertex meet in nothing but the corners and edges they share:
/// seen along some direction, all of them face it and they turn around the vertex less than once, or exactly once.
/// [docs/mathematics.md, "Stars"]
///
/// On a smooth surface that is every vertex, and no pair of neighbours needs a test of its own.
class Stars {
 public:
  /// @param triangles (F, 3) corners, repeated ones allowed
  Stars(const std::vector<std::array<Index, 3>>& triangles, Index vertex_count);

  /// 1 for each vertex whose star is proven free, which is certain; 0 means nothing. `moved` as in
  /// IntersectionTest::is_free: stars in which nothing moved are not asked for, and get 0.
  std::vector<unsigned char> find_free(const PointRows& points, const std::vector<unsigned char>& moved,
                                       const Execution& execution) const;

 private:
  /// The vertices around, in order: triangle k is (vertex, rim k, rim k + 1); around a closed star the last is the
  /// first. Empty: the triangles are not a single fan, or one alone, or too many.
  std::span<const Index> rim(Index vertex) const;

  /// How many triangles, and whether they are closed.
  std::pair<std::size_t, bool> shape(Index vertex) const;

  std::vector<Index> start_;  // of each rim, (N + 1)
  std::vector<Index> rims_;
  std::vector<Index> stars_;  // vertices with a rim, those of one shape next to each other
};

}  // namespace stiv
