// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "large_array.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Edges or triangles (rows of 2 or 3 vertices) in the order in which a curve visits the vertices, given the place of
/// each vertex along it. An edge comes at its first corner, a triangle at the middle one, which is closer to its
/// center. Linear, and much faster than sorting primitives by their own places on the curve.
LargeArray<Index> order_by_corners(const Index* rows, Index count, Index size, std::span<const Index> places);

}  // namespace stiv
