// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/types.hpp"

namespace stiv {

using Segment = std::array<Vector3, 2>;
using Triangle = std::array<Vector3, 3>;

/// Closed sets in space, of any rank: a segment may be a point, a triangle a segment or a point. All exact.

/// An axis along which the triangle projects to non-zero area; -1 if its area is zero.
int projection_axis(const Triangle& triangle);

bool segments_meet(const Segment& first, const Segment& second);
bool segment_meets_triangle(const Segment& segment, const Triangle& triangle);
bool triangles_meet(const Triangle& first, const Triangle& second);

/// Do the triangles (corner, a0, a1) and (corner, b0, b1) meet in a point other than `corner`?
bool fans_meet(const Vector3& corner, const Segment& a, const Segment& b);

/// Do the triangles (e0, e1, a) and (e0, e1, b) meet in a point off the segment e0 e1?
bool wings_meet(const Segment& edge, const Vector3& a, const Vector3& b);

}  // namespace stiv
