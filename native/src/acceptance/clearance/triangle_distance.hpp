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

}  // namespace stiv
