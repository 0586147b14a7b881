// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/winding_numbers.hpp"

#include "penetration/piercing.hpp"

namespace stiv {

namespace {

/// A segment along x from the point to outside the body.
Segment ray_beyond(const PlacedBody& body, const Vector3& point) {
  const double furthest = body.box().max().cwiseAbs().x();
  Vector3 end = point;
  end.x() = furthest > 0 ? 2 * furthest : 1;
  return {point, end};
}

/// True if a ray along x intersects the box of the triangle.
bool ray_hits_box(const Vector3& point, const Triangle& triangle) {
  for (int axis = 1; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    if (point[axis] < low || point[axis] > high) return false;
  }
  return point.x() <= std::max({triangle[0].x(), triangle[1].x(), triangle[2].x()});
}

/// Area of the triangle of the first corner and the cut, as a fraction of the whole triangle.
double swept_fraction(const std::array<Eigen::Vector2d, 2>& ends) {
  return ends[0].x() * ends[1].y() - ends[0].y() * ends[1].x();
}

}  // namespace

int winding_number(const PlacedBody& closed, const Vector3& point, int perturbation) {
  if (!closed.box().contains(point)) return 0;
  const Segment ray = ray_beyond(closed, point);
  int increase = 0;
  bool touching = false;  // unused
  for (Index k = 0; k < closed.triangle_count(); ++k) {
    const Triangle triangle = closed.triangle(k);
    if (!ray_hits_box(point, triangle)) continue;
    if (const auto pierced = piercing(ray, triangle, perturbation, touching)) increase += pierced->step;
  }
  return -increase;  // to 0, outside
}

std::vector<int> winding_numbers(const Crossings& crossings, std::size_t side) {
  const PlacedBody& body = crossings.body(side);
  std::vector<int> numbers(body.mesh().vertices.size(), 0);
  const auto number = [&](Index vertex) -> int& { return numbers[at(vertex)]; };
  for (const Index seed : body.mesh().seeds)
    number(seed) = winding_number(crossings.body(1 - side), body.point(seed), crossings.perturbation(side));
  for (const auto& [from, to] : body.mesh().walk)
    number(to) = number(from) + crossings.winding_increase(side, from, to);
  return numbers;
}

// By the divergence theorem in the plane of the triangle, with the first corner as origin: of the boundary, only the
// opposite side contributes, and each cut, where w changes by 1, contributes the area that it sweeps.
std::vector<double> mean_windings(const Crossings& crossings, std::size_t side) {
  const std::vector<int> numbers = winding_numbers(crossings, side);
  const PlacedBody& body = crossings.body(side);
  std::vector<double> means;
  for (Index k = 0; k < body.triangle_count(); ++k) {
    const auto& corners = body.corners(k);
    means.push_back(crossings.mean_along(side, corners[1], corners[2], numbers[at(corners[1])]));
  }
  for (const Cut& cut : crossings.cuts())
    means[at(cut.triangles[side])] += side == 0 ? swept_fraction(cut.ends[0]) : -swept_fraction(cut.ends[1]);
  return means;
}

}  // namespace stiv
