// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/types.hpp"

namespace stiv {

using Segment = std::array<Vector3, 2>;
using Triangle = std::array<Vector3, 3>;

/// Exact tests of closed sets. A segment may degenerate to a point, a triangle to a segment or a point.

/// An axis along which the triangle's projection has area; -1 if the triangle has none.
int projection_axis(const Triangle& triangle);

bool segments_intersect(const Segment& first, const Segment& second);
bool segment_intersects_triangle(const Segment& segment, const Triangle& triangle);
bool triangles_intersect(const Triangle& first, const Triangle& second);

/// True if the triangles (corner, a0, a1) and (corner, b0, b1) share a point other than `corner`.
bool vertex_neighbours_intersect(const Vector3& corner, const Segment& a, const Segment& b);

/// True if the triangles (e0, e1, a) and (e0, e1, b) share a point off the segment e0 e1.
bool edge_neighbours_intersect(const Segment& edge, const Vector3& a, const Vector3& b);

}  // namespace stiv
