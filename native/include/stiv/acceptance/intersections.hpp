// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "stiv/acceptance/deviation_test.hpp"
#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// True if two triangles intersect apart from the hull of their shared vertices (nothing, a vertex, an edge). Shared
/// vertices have equal indices; two triangles that share three always intersect. Touching, coplanar overlap, coincident
/// vertices of different index and neighbors folded flat onto each other are intersections. A triangle without area is
/// a segment or a point. Exact for coordinates in the range of coordinate_range.hpp.
/// @param first, second corners, rows of q
bool triangles_intersect(const std::array<Index, 3>& first, const std::array<Index, 3>& second, const PositionsView& q);

/// Pairs of indices, sorted.
using IndexPairs = std::vector<std::pair<Index, Index>>;

/// For each pair of triangles, a bound of the depth to which they intersect: the shortest motion that parts the two
/// along one of their separating axes. Corners that they share do not count as an intersection.
/// @param q (N, 3)
/// @throws InputError: a triangle out of range
std::vector<double> intersection_depths(const Surface& surface, const IndexPairs& pairs, const PositionsView& q);

/// All intersections of a surface at rest.
struct StaticPairs {
  IndexPairs faces;           ///< pairs of triangles, smaller index first
  IndexPairs loose_edges;     ///< (loose edge, triangle)
  IndexPairs loose_vertices;  ///< (vertex of no edge, triangle)

  Index count() const { return static_cast<Index>(faces.size() + loose_edges.size() + loose_vertices.size()); }
  bool empty() const { return count() == 0; }
};

struct IntersectionTestOptions {
  bool lists_near_pairs = false;  ///< for `deviation_test`
  Index resting = 0;  ///< the last vertices, this many, have the same positions in all calls. Their pairs are left out
};

/// Exact static test of a whole surface at positions q, (N, 3), all finite. It keeps its trees between calls. Pairs of
/// bodies that do not meet are left out. Results do not depend on the number of threads.
class IntersectionTest {
 public:
  explicit IntersectionTest(std::shared_ptr<const Surface> surface, IntersectionTestOptions options = {});
  ~IntersectionTest();
  IntersectionTest(IntersectionTest&&) noexcept;
  IntersectionTest& operator=(IntersectionTest&&) noexcept;

  /// All pairs of triangles (smaller index first) that intersect.
  IndexPairs find(const PositionsView& q, Execution& execution);

  /// These, and the loose edges and vertices that intersect triangles apart from their shared vertices.
  StaticPairs find_all(const PositionsView& q, Execution& execution);

  /// Pairs of triangles that may intersect where each coordinate differs from q by at most `distance`, and some others
  /// that are near. For options that list near pairs.
  IndexPairs find_near(const PositionsView& q, double distance, Execution& execution);

  /// The loose edges and vertices of `find_all`, and those that are nearer to triangles than `distance` beside their
  /// common vertices. For options that list near pairs.
  StaticPairs find_near_loose(const PositionsView& q, double distance, Execution& execution);

  /// True if nothing intersects; stops at the first intersection.
  /// @param moved (N) nonzero for vertices that differ from a state known to be free; only pairs with a moved vertex
  /// are tested. Empty: all
  bool is_free(const PositionsView& q, const std::vector<unsigned char>& moved, Execution& execution);

  /// The test of surfaces that deviate from q by rounding, for options that list near pairs. Null unless q was the last
  /// surface without intersections in `find_all` or `is_free`.
  std::shared_ptr<const DeviationTest> deviation_test(const PositionsView& q) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace stiv
