// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/acceptance/least_distance.hpp"

namespace stiv {

/// The closest points of the boundaries of two triangles, which are those of the triangles unless they intersect. Does
/// not set NearestTriangles::triangles.
NearestTriangles triangle_distance(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                                   const PositionsView& q);

/// A fast lower bound of their distance, with a margin for rounding: from planes orthogonal to the line through the
/// centers and parallel to each triangle.
double least_triangle_distance(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                               const PositionsView& q);

/// Bound of the depth to which two triangles intersect: the shortest motion that parts them along one of their
/// separating axes. Corners that they share do not count as an intersection.
double intersection_depth(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                          const PositionsView& q);

}  // namespace stiv
