// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/acceptance/intersections.hpp"

namespace stiv {

/// All that intersects in a surface at rest.
struct StaticPairs {
  IndexPairs faces;           ///< pairs of triangles
  IndexPairs loose_edges;     ///< (loose edge, triangle)
  IndexPairs loose_vertices;  ///< (vertex of no edge, triangle)

  Index count() const { return static_cast<Index>(faces.size() + loose_edges.size() + loose_vertices.size()); }
  bool empty() const { return count() == 0; }
};

inline StaticPairs find_static_pairs(IntersectionTest& test, const Positions& q, Execution& execution) {
  return {test.find(q, execution), test.find_loose_edges(q, execution), test.find_loose_vertices(q, execution)};
}

}  // namespace stiv
