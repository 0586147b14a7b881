// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "acceptance/intersection/exact_intersection.hpp"

namespace stiv {

/// Fast proofs that two triangles do not intersect, in floating point with rounding bounds. True is certain; false is
/// inconclusive. They decide nearly all pairs, even on flat surfaces, where exact determinants are expensive.

/// Tries planes orthogonal to the line through the centers, and planes through an edge along an axis.
bool separated_by_plane(const Triangle& a, const Triangle& b);

/// True: (corner, a0, a1) and (corner, b0, b1) share only the corner.
bool separated_at_corner(const Vector3& corner, const Segment& a, const Segment& b);

/// True: (e0, e1, a) and (e0, e1, b) share only the edge, which separates a and b in a projection along some axis.
bool separated_at_edge(const Segment& edge, const Vector3& a, const Vector3& b);

}  // namespace stiv
