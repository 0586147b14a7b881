// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "acceptance/intersection/exact_meeting.hpp"

namespace stiv {

/// Quick proofs that two triangles do not meet, in plain floating point with a rounding bound. True is certain; false
/// means nothing. They decide nearly all pairs, flat surfaces included, where exact determinants vanish and are dear.

/// Separated by a plane across the line that joins the centres, or over an edge of one in some projection.
bool clearly_apart(const Triangle& a, const Triangle& b);

/// (corner, a0, a1) and (corner, b0, b1) meet in the corner alone.
bool clearly_apart_at_corner(const Vector3& corner, const Segment& a, const Segment& b);

/// (e0, e1, a) and (e0, e1, b) meet in the edge alone: seen along some axis, it runs between a and b.
bool clearly_apart_at_edge(const Segment& edge, const Vector3& a, const Vector3& b);

}  // namespace stiv
