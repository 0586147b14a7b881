// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "editing/surface_parts.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Pairs of triangles of parts that lie on each other, which do not touch at the start, but would once one part slides
/// or turns on the other. Both are sorted, with the smaller index first.
struct PairsInContactPlanes {
  IndexPairs facing;  ///< in one plane
  IndexPairs beside;  ///< one in that plane, the other one only beside triangles of its part in that plane
};

/// Finds these pairs around those that lie on each other: across the coplanar neighbors of both triangles. A large
/// floor is covered as far as a limited number of pairs reaches, nearest ones first. (mathematics.md, "Excluded pairs")
/// @param flush pairs of triangles of parts that only touch, sorted, with the smaller index first
/// @param around triangles of each vertex
/// @param rounding distances below it are rounding
PairsInContactPlanes find_in_contact_planes(const Surface& surface, const SurfaceParts& parts, const IndexPairs& flush,
                                            const std::vector<std::vector<Index>>& around, const PositionsView& start,
                                            double rounding);

}  // namespace stiv
