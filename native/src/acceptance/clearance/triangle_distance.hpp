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

/// The distance of two triangles that do not intersect; of triangles with one or two common corners, that of the sides
/// and corners that are not common. A triangle whose first two corners are equal is a segment.
double distance_apart(std::array<Index, 3> a, std::array<Index, 3> b, const PositionsView& q);

/// Bound of the depth to which two triangles intersect: the shortest motion that parts them along one of their
/// separating axes. Corners that they share do not count as an intersection.
double intersection_depth(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                          const PositionsView& q);

/// Whether this depth is at least a given one.
bool intersect_deeper(const std::array<Index, 3>& first, const std::array<Index, 3>& second, const PositionsView& q,
                      double depth);

/// Whether two triangles lie in one plane and face the same way, up to a tolerance, and overlap there by more than it.
bool overlap_in_plane(const std::array<Index, 3>& first, const std::array<Index, 3>& second, const PositionsView& q,
                      double tolerance);

/// The direction from the second triangle to the first along which they overlap least at `end`, of those along their
/// separating axes in which they overlap by less than `tolerance` at `start`; zero if there is none. A normal of either
/// comes first: in a flat wall, other directions would keep a face from sliding over the edges of triangles.
Vector3 parting_direction(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                          const PositionsView& start, const PositionsView& end, double tolerance);

}  // namespace stiv
