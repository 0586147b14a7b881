// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "penetration/crossings.hpp"

namespace stiv {

/// How often a closed body winds around a point, 1 inside of one that faces outward: counted exactly along a ray.
/// @param nudge of the point: see nudged_orientation.hpp
int winding_number(const PlacedBody& closed, const Vector3& point, int nudge);

/// How often the other body, which is closed, winds around each vertex of the body of a side: along a ray from one
/// vertex of each component, and from there along edges by what they cross.
std::vector<int> winding_numbers(const Crossings& crossings, std::size_t side);

}  // namespace stiv
