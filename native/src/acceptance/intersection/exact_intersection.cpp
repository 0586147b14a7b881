// SPDX-License-Identifier: GPL-3.0-or-later
// Derivations: docs/mathematics.md, "Exact static test".
#include "acceptance/intersection/exact_intersection.hpp"

#include <algorithm>

#include "acceptance/intersection/predicates.hpp"

namespace stiv {

namespace {

/// True if both are strictly on the same side.
bool same_side(int a, int b) { return a * b > 0; }

bool boxes_overlap(const Segment& first, const Segment& second) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [a_low, a_high] = std::minmax(first[0][axis], first[1][axis]);
    const auto [b_low, b_high] = std::minmax(second[0][axis], second[1][axis]);
    if (a_high < b_low || b_high < a_low) return false;
  }
  return true;
}

/// Segments in one plane whose projection along `drop` has area.
bool segments_intersect_in_plane(const Segment& first, const Segment& second, int drop) {
  const int b0 = orientation_2d(first[0], first[1], second[0], drop);
  const int b1 = orientation_2d(first[0], first[1], second[1], drop);
  if (same_side(b0, b1)) return false;
  const int a0 = orientation_2d(second[0], second[1], first[0], drop);
  const int a1 = orientation_2d(second[0], second[1], first[1], drop);
  if (same_side(a0, a1)) return false;
  const bool collinear = b0 == 0 && b1 == 0 && a0 == 0 && a1 == 0;
  return !collinear || boxes_overlap(first, second);
}

/// For a point in the plane of a triangle whose projection along `drop` has area.
bool inside_in_plane(const Vector3& point, const Triangle& triangle, int drop) {
  const int s0 = orientation_2d(triangle[0], triangle[1], point, drop);
  const int s1 = orientation_2d(triangle[1], triangle[2], point, drop);
  const int s2 = orientation_2d(triangle[2], triangle[0], point, drop);
  return std::min({s0, s1, s2}) >= 0 || std::max({s0, s1, s2}) <= 0;
}

template <class Test>
bool any_edge(const Triangle& triangle, const Test& test) {
  for (std::size_t k = 0; k < 3; ++k)
    if (test(Segment{triangle[k], triangle[(k + 1) % 3]})) return true;
  return false;
}

bool segment_intersects_coplanar_triangle(const Segment& segment, const Triangle& triangle) {
  const int drop = projection_axis(triangle);
  // Without area the triangle is the union of its edges.
  if (drop < 0) return any_edge(triangle, [&](const Segment& edge) { return segments_intersect(segment, edge); });
  return inside_in_plane(segment[0], triangle, drop) ||
         any_edge(triangle, [&](const Segment& edge) { return segments_intersect_in_plane(segment, edge, drop); });
}

bool all_strictly_on_one_side(const Triangle& plane, const Triangle& points) {
  const int side = orientation_3d(plane[0], plane[1], plane[2], points[0]);
  return same_side(side, orientation_3d(plane[0], plane[1], plane[2], points[1])) &&
         same_side(side, orientation_3d(plane[0], plane[1], plane[2], points[2]));
}

/// The side of a triangle opposite to a corner. A triangle without area has two segments instead, from the corner to
/// each of the other vertices.
struct Sides {
  std::array<Segment, 2> side;
  std::size_t count = 0;

  Sides(const Vector3& corner, const Segment& opposite) {
    if (projection_axis({corner, opposite[0], opposite[1]}) >= 0) {
      side[count++] = opposite;
      return;
    }
    for (const Vector3& end : opposite)
      if (end != corner) side[count++] = {end, end};
  }
};

/// True if a and b, on the line of the edge, are both beyond the same end of it.
bool same_end(const Segment& edge, const Vector3& a, const Vector3& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax(edge[0][axis], edge[1][axis]);
    if (low < high) return (a[axis] > high && b[axis] > high) || (a[axis] < low && b[axis] < low);
  }
  return false;
}

}  // namespace

int projection_axis(const Triangle& triangle) {
  for (int drop = 0; drop < 3; ++drop)
    if (orientation_2d(triangle[0], triangle[1], triangle[2], drop) != 0) return drop;
  return -1;
}

bool segments_intersect(const Segment& first, const Segment& second) {
  if (!boxes_overlap(first, second)) return false;
  if (orientation_3d(first[0], first[1], second[0], second[1]) != 0) return false;
  for (const Triangle& triple : {Triangle{first[0], first[1], second[0]}, Triangle{first[0], first[1], second[1]},
                                 Triangle{second[0], second[1], first[0]}, Triangle{second[0], second[1], first[1]}}) {
    const int drop = projection_axis(triple);
    if (drop >= 0) return segments_intersect_in_plane(first, second, drop);
  }
  return true;  // all on one line, where boxes that overlap share a point
}

bool segment_intersects_triangle(const Segment& segment, const Triangle& triangle) {
  const int side_0 = orientation_3d(triangle[0], triangle[1], triangle[2], segment[0]);
  const int side_1 = orientation_3d(triangle[0], triangle[1], triangle[2], segment[1]);
  if (same_side(side_0, side_1)) return false;
  if (side_0 == 0 && side_1 == 0) return segment_intersects_coplanar_triangle(segment, triangle);
  // The segment intersects the plane in one point: test whether the triangle contains it.
  const int s0 = orientation_3d(segment[0], segment[1], triangle[0], triangle[1]);
  const int s1 = orientation_3d(segment[0], segment[1], triangle[1], triangle[2]);
  const int s2 = orientation_3d(segment[0], segment[1], triangle[2], triangle[0]);
  return std::min({s0, s1, s2}) >= 0 || std::max({s0, s1, s2}) <= 0;
}

bool triangles_intersect(const Triangle& first, const Triangle& second) {
  if (all_strictly_on_one_side(first, second) || all_strictly_on_one_side(second, first)) return false;
  return any_edge(first, [&](const Segment& edge) { return segment_intersects_triangle(edge, second); }) ||
         any_edge(second, [&](const Segment& edge) { return segment_intersects_triangle(edge, first); });
}

bool vertex_neighbours_intersect(const Vector3& corner, const Segment& a, const Segment& b) {
  // If they share another point, they share a segment from the corner to the opposite side of one of them.
  const Sides first(corner, a), second(corner, b);
  for (std::size_t i = 0; i < first.count; ++i) {
    for (std::size_t j = 0; j < second.count; ++j) {
      const Segment &from = first.side[i], &to = second.side[j];
      if (segment_intersects_triangle(from, {corner, to[0], to[1]})) return true;
      if (segment_intersects_triangle(to, {corner, from[0], from[1]})) return true;
    }
  }
  return false;
}

bool edge_neighbours_intersect(const Segment& edge, const Vector3& a, const Vector3& b) {
  if (edge[0] == edge[1]) return vertex_neighbours_intersect(edge[0], {a, a}, {b, b});
  if (orientation_3d(edge[0], edge[1], a, b) != 0) return false;
  const int drop_a = projection_axis({edge[0], edge[1], a});
  const int drop_b = projection_axis({edge[0], edge[1], b});
  if (drop_a < 0 && drop_b < 0) return same_end(edge, a, b);
  if (drop_a < 0 || drop_b < 0) return false;  // one is degenerate, on the line of the edge
  return same_side(orientation_2d(edge[0], edge[1], a, drop_a), orientation_2d(edge[0], edge[1], b, drop_a));
}

}  // namespace stiv
