// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/acceptance/least_distance.hpp"

namespace stiv {

/// The nearest points of the borders and corners of two triangles: the nearest points of the triangles, unless they
/// intersect. `triangles` is left to the caller.
NearestTriangles triangle_distance(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                                   const PositionsView& q);

/// A quick bound from below of their distance, a little loose for rounding: by planes across the line of the centres
/// and along both triangles.
double least_triangle_distance(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                               const PositionsView& q);

}  // namespace stiv
