// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// The place of each point (finite) along a space-filling curve.
std::vector<Index> places_along_curve(const std::vector<Eigen::Vector3f>& points);

/// Primitives with `size` corners each (1, 2 or 3) in the order in which a curve visits the vertices, given the place
/// of each vertex along it. A primitive comes at its first corner, or for triangles at the middle one, which is closer
/// to its center. Linear, and much faster than sorting primitives by their own places on the curve.
std::vector<Index> order_by_corners(const Index* rows, Index count, Index size, const std::vector<Index>& places);

}  // namespace stiv
