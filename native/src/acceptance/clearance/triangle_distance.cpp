// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/clearance/triangle_distance.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/distance.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

using Corners = std::array<Vector3, 3>;

Corners seen_from(const Vector3& origin, const std::array<Index, 3>& triangle, const PositionsView& q) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = q.row(triangle[k]).transpose() - origin;
  return corners;
}

/// The gap between two triangles along a direction, in units of its length.
double gap_along(const Vector3& direction, const Corners& a, const Corners& b) {
  const double length = direction.norm();
  if (!(length > 0)) return 0;
  double high = -std::numeric_limits<double>::infinity(), low = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    high = std::max(high, direction.dot(a[k]));
    low = std::min(low, direction.dot(b[k]));
  }
  return (low - high) / length;
}

/// The motion along an axis that parts two triangles; infinite if the axis has no direction.
double parting_motion(const Vector3& axis, const Corners& a, const Corners& b) {
  if (!(axis.norm() > 0)) return std::numeric_limits<double>::infinity();
  return std::max(0.0, -std::max(gap_along(axis, a, b), gap_along(axis, b, a)));
}

Corners sides_of(const Corners& triangle) {
  return {triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]};
}

/// The normal, of any length.
Vector3 normal_of(const Corners& triangle) { return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]); }

/// Whether a test is true for an axis of the separating axis theorem, of any length.
template <class Test>
bool any_separating_axis(const Corners& a, const Corners& b, const Test& test) {
  for (const Corners& sides : {sides_of(a), sides_of(b)}) {
    const Vector3 normal = sides[0].cross(sides[1]);
    if (test(normal)) return true;
    for (const Vector3& side : sides)
      if (test(normal.cross(side))) return true;
  }
  for (const Vector3& side : sides_of(a))
    for (const Vector3& other : sides_of(b))
      if (test(side.cross(other))) return true;
  return false;
}

/// Calls a function with each of these axes.
template <class Call>
void for_separating_axes(const Corners& a, const Corners& b, const Call& call) {
  any_separating_axis(a, b, [&](const Vector3& axis) {
    call(axis);
    return false;
  });
}

using Triangle = std::array<Index, 3>;

bool has(const Triangle& triangle, Index corner) {
  return std::find(triangle.begin(), triangle.end(), corner) != triangle.end();
}

/// The triangle with its corners that another one has at its end. Returns how many these are.
std::ptrdiff_t put_shared_last(Triangle& triangle, const Triangle& other) {
  const auto shared =
      std::partition(triangle.begin(), triangle.end(), [&](Index corner) { return !has(other, corner); });
  return triangle.end() - shared;
}

}  // namespace

double least_triangle_distance(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                               const PositionsView& q) {
  const Vector3 origin = q.row(first[0]);
  const Corners a = seen_from(origin, first, q), b = seen_from(origin, second, q);
  const Vector3 centres = b[0] + b[1] + b[2] - a[0] - a[1] - a[2];
  double gap = gap_along(centres, a, b);
  for (const Corners& triangle : {a, b}) {
    const Vector3 normal = normal_of(triangle);
    gap = std::max(gap, gap_along(normal.dot(centres) < 0 ? Vector3(-normal) : normal, a, b));
  }
  return gap * (1 - 0x1p-40);
}

NearestTriangles triangle_distance(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                                   const PositionsView& q) {
  const Vector3 origin = q.row(first[0]);  // rounding then scales with the pair, not with the scene
  const Corners a = seen_from(origin, first, q), b = seen_from(origin, second, q);
  NearestTriangles nearest;
  nearest.distance = std::numeric_limits<double>::infinity();
  const auto take = [&](double distance, const Vector3& on_first, const Vector3& on_second) {
    if (distance >= nearest.distance) return;
    nearest.distance = distance;
    nearest.points = {origin + on_first, origin + on_second};
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Witness from_first = point_triangle<double>({a[i], b[0], b[1], b[2]});
    take(from_first.distance, a[i], a[i] - from_first.separation);
    const Witness from_second = point_triangle<double>({b[i], a[0], a[1], a[2]});
    take(from_second.distance, b[i] - from_second.separation, b[i]);
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t next_i = (i + 1) % 3, next_j = (j + 1) % 3;
      const Witness edges = segment_segment<double>({a[i], a[next_i], b[j], b[next_j]});
      const Vector3 on_first = edges.weights[0] * a[i] + edges.weights[1] * a[next_i];
      take(edges.distance, on_first, on_first - edges.separation);
    }
  }
  return nearest;
}

double distance_apart(std::array<Index, 3> a, std::array<Index, 3> b, const PositionsView& q) {
  const auto distance = [&](const Triangle& first, const Triangle& second) {
    return triangle_distance(first, second, q).distance;
  };
  const std::ptrdiff_t shared = put_shared_last(a, b);
  put_shared_last(b, a);
  if (shared == 0) return distance(a, b);
  if (shared == 1) return std::min(distance({a[0], a[1], a[1]}, b), distance(a, {b[0], b[1], b[1]}));
  const double to_corners = std::min(distance({a[0], a[0], a[0]}, b), distance(a, {b[0], b[0], b[0]}));
  const Index v = a[1], w = a[2];  // sides that meet in no corner
  return std::min({to_corners, distance({v, a[0], a[0]}, {w, b[0], b[0]}), distance({w, a[0], a[0]}, {v, b[0], b[0]})});
}

double intersection_depth(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                          const PositionsView& q) {
  const Vector3 origin = q.row(first[0]);
  const Corners a = seen_from(origin, first, q), b = seen_from(origin, second, q);
  double depth = std::numeric_limits<double>::infinity();
  for_separating_axes(a, b, [&](const Vector3& axis) { depth = std::min(depth, parting_motion(axis, a, b)); });
  return depth;
}

bool intersect_deeper(const std::array<Index, 3>& first, const std::array<Index, 3>& second, const PositionsView& q,
                      double depth) {
  const Vector3 origin = q.row(first[0]);
  const Corners a = seen_from(origin, first, q), b = seen_from(origin, second, q);
  return !any_separating_axis(a, b, [&](const Vector3& axis) { return parting_motion(axis, a, b) < depth; });
}

bool overlap_in_plane(const std::array<Index, 3>& first, const std::array<Index, 3>& second, const PositionsView& q,
                      double tolerance) {
  const Vector3 origin = q.row(first[0]);
  const Corners a = seen_from(origin, first, q), b = seen_from(origin, second, q);
  const Vector3 normal = normal_of(a), other = normal_of(b);
  const auto in_plane = [&](const Vector3& along) {
    return along.norm() > 0 && std::max(-gap_along(along, a, b), -gap_along(along, b, a)) <= tolerance;
  };
  if (normal.dot(other) <= 0 || !in_plane(normal) || !in_plane(other)) return false;
  bool overlap = true;
  for (const auto& [corners, up] : {std::pair(a, normal), std::pair(b, other)})
    for (const Vector3& side : sides_of(corners)) overlap &= parting_motion(up.cross(side), a, b) > tolerance;
  return overlap;
}

Vector3 parting_direction(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                          const PositionsView& start, const PositionsView& end, double tolerance) {
  const Corners a = seen_from(start.row(first[0]), first, start), b = seen_from(start.row(first[0]), second, start);
  const Corners a_at_end = seen_from(end.row(first[0]), first, end),
                b_at_end = seen_from(end.row(first[0]), second, end);
  Vector3 best = Vector3::Zero();
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vector3& axis) {
    if (!(axis.norm() > 0)) return;
    for (const Vector3& direction : {axis, Vector3(-axis)}) {
      const double overlap = -gap_along(direction, b_at_end, a_at_end);
      if (overlap >= least || -gap_along(direction, b, a) >= tolerance) continue;
      least = overlap;
      best = direction.normalized();
    }
  };
  for (const Corners& sides : {sides_of(a), sides_of(b)}) consider(sides[0].cross(sides[1]));
  if (best.isZero()) for_separating_axes(a, b, consider);
  return best;
}

std::vector<double> intersection_depths(const Surface& surface, const IndexPairs& pairs, const PositionsView& q) {
  const Triangles& triangles = surface.triangles();
  const auto corners = [&](Index triangle) {
    if (triangle < 0 || triangle >= triangles.rows())
      throw InputError("pairs: " + std::to_string(triangle) + " is not one of the " + std::to_string(triangles.rows()) +
                       " triangles");
    return std::array{triangles(triangle, 0), triangles(triangle, 1), triangles(triangle, 2)};
  };
  std::vector<double> depths;
  depths.reserve(pairs.size());
  for (const auto& [a, b] : pairs) depths.push_back(intersection_depth(corners(a), corners(b), q));
  return depths;
}

}  // namespace stiv
