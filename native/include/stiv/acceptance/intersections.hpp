// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Do two triangles meet in a point off the hull of the vertices they share (nothing, that vertex, that edge)? Shared
/// corners are told by equal indices; three of them always count as meeting. Touching, coplanar overlap, coincident
/// vertices of different index and neighbours folded flat onto each other count; triangles without area are segments or
/// points. Exact in the range of orientation_3d.
bool triangles_intersect(const std::array<Index, 3>& first, const std::array<Index, 3>& second, const PositionsView& q);

/// Pairs of indices, sorted.
using IndexPairs = std::vector<std::pair<Index, Index>>;

/// All that intersects in a surface at rest.
struct StaticPairs {
  IndexPairs faces;           ///< pairs of triangles
  IndexPairs loose_edges;     ///< (loose edge, triangle)
  IndexPairs loose_vertices;  ///< (vertex of no edge, triangle)

  Index count() const { return static_cast<Index>(faces.size() + loose_edges.size() + loose_vertices.size()); }
  bool empty() const { return count() == 0; }
};

/// Exact static test of a whole surface; keeps its trees between calls. Pairs of bodies that do not meet are left out.
/// Positions are finite. Results do not depend on the number of threads.
class IntersectionTest {
 public:
  explicit IntersectionTest(std::shared_ptr<const Surface> surface);
  ~IntersectionTest();
  IntersectionTest(IntersectionTest&&) noexcept;
  IntersectionTest& operator=(IntersectionTest&&) noexcept;

  /// All pairs of triangles (smaller index first) that intersect at positions q, (N, 3).
  IndexPairs find(const PositionsView& q, Execution& execution);

  /// Pairs (loose edge, triangle) that meet off the vertices they share.
  IndexPairs find_loose_edges(const PositionsView& q, Execution& execution);

  /// Pairs (vertex of no edge at all, triangle) that meet.
  IndexPairs find_loose_vertices(const PositionsView& q, Execution& execution);

  /// True if there is none of any kind; ends at the first. `moved` (N, may be empty: all) marks vertices that differ
  /// from a state known to be free: pairs of which no vertex is marked are not looked at.
  bool is_free(const PositionsView& q, const std::vector<unsigned char>& moved, Execution& execution);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

inline StaticPairs find_static_pairs(IntersectionTest& test, const Positions& q, Execution& execution) {
  return {test.find(q, execution), test.find_loose_edges(q, execution), test.find_loose_vertices(q, execution)};
}

}  // namespace stiv
