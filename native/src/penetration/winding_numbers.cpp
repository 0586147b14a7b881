// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/winding_numbers.hpp"

#include "penetration/piercing.hpp"

namespace stiv {

namespace {

/// From the point along x to beyond the body.
Segment ray_beyond(const PlacedBody& body, const Vector3& point) {
  const double farthest = body.box().max().cwiseAbs().x();
  Vector3 end = point;
  end.x() = farthest > 0 ? 2 * farthest : 1;
  return {point, end};
}

/// Does a ray along x meet the box of the triangle?
bool may_meet(const Vector3& point, const Triangle& triangle) {
  for (int axis = 1; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    if (point[axis] < low || point[axis] > high) return false;
  }
  return point.x() <= std::max({triangle[0].x(), triangle[1].x(), triangle[2].x()});
}

}  // namespace

int winding_number(const PlacedBody& closed, const Vector3& point, int nudge) {
  if (!closed.box().contains(point)) return 0;
  const Segment ray = ray_beyond(closed, point);
  int gained = 0;
  bool touching = false;  // of no interest
  for (Index k = 0; k < closed.triangle_count(); ++k) {
    const Triangle triangle = closed.triangle(k);
    if (!may_meet(point, triangle)) continue;
    if (const auto pierced = piercing(ray, triangle, nudge, touching)) gained += pierced->step;
  }
  return -gained;  // to 0, outside
}

std::vector<int> winding_numbers(const Crossings& crossings, std::size_t side) {
  const PlacedBody& body = crossings.body(side);
  std::vector<int> numbers(body.mesh().vertices.size(), 0);
  const auto number = [&](Index vertex) -> int& { return numbers[at(vertex)]; };
  for (const Index seed : body.mesh().seeds)
    number(seed) = winding_number(crossings.body(1 - side), body.point(seed), crossings.nudge(side));
  for (const auto& [from, to] : body.mesh().walk) number(to) = number(from) + crossings.gained(side, from, to);
  return numbers;
}

}  // namespace stiv
