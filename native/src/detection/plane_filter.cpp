// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/plane_filter.hpp"

#include <cmath>
#include <limits>

namespace stiv {

namespace {

// As comparisons that compile to one instruction, which std::min with references does not everywhere.
double least(double a, double b) { return a < b ? a : b; }
double most(double a, double b) { return a > b ? a : b; }

struct Point {
  double x, y, z;
};

Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double sum(const Point& a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); }

/// How far the first side lies beyond the second along n, or the second beyond the first: the first vertex projects to
/// zero. A step is linear, so the lesser of the values at both ends holds in between.
struct Gaps {
  double beyond, before;
};

template <EventKind kind>
Gaps gaps(double p1, double p2, double p3) {
  if constexpr (kind == EventKind::vertex_face)
    return {-most(most(p1, p2), p3), least(least(p1, p2), p3)};
  else
    return {least(0, p1) - most(p2, p3), least(p2, p3) - most(0, p1)};
}

}  // namespace

void PlaneFilter::set(std::size_t lane, const std::array<Index, 4>& vertices, const Positions& start,
                      const Positions& end) {
  const double* const from = start.data() + 3 * static_cast<std::ptrdiff_t>(vertices[0]);
  const double* const to = end.data() + 3 * static_cast<std::ptrdiff_t>(vertices[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const double* const a = start.data() + 3 * static_cast<std::ptrdiff_t>(vertices[k + 1]);
    const double* const b = end.data() + 3 * static_cast<std::ptrdiff_t>(vertices[k + 1]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      start_[k][axis][lane] = a[axis] - from[axis];
      end_[k][axis][lane] = b[axis] - to[axis];
    }
  }
}

// The bound of rounding is that of RelativeMotion, with the normal's length bounded by the sum of its components. The
// comparison is strict and allows for underflow, so that a normal that vanishes separates nothing.
template <EventKind kind>
std::array<int, PlaneFilter::width> PlaneFilter::apart(double separation) const {
  constexpr double underflow = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
  Lanes excess;
  for (std::size_t lane = 0; lane < width; ++lane) {
    const auto at = [&](const auto& points, std::size_t k) {
      return Point{points[k][0][lane], points[k][1][lane], points[k][2][lane]};
    };
    const Point a1 = at(start_, 0), a2 = at(start_, 1), a3 = at(start_, 2);
    const Point b1 = at(end_, 0), b2 = at(end_, 1), b3 = at(end_, 2);
    const Point normal = kind == EventKind::vertex_face ? cross(a2 - a1, a3 - a1) : cross(a1, a3 - a2);
    const Gaps first = gaps<kind>(dot(normal, a1), dot(normal, a2), dot(normal, a3));
    const Gaps last = gaps<kind>(dot(normal, b1), dot(normal, b2), dot(normal, b3));
    const double gap = most(least(first.beyond, last.beyond), least(first.before, last.before));
    const double magnitude = most(most(most(sum(a1), sum(a2)), sum(a3)), most(most(sum(b1), sum(b2)), sum(b3)));
    excess[lane] = gap - ((separation + 0x1p-46 * magnitude) * sum(normal) + underflow);
  }
  std::array<int, width> result;
  for (std::size_t lane = 0; lane < width; ++lane) result[lane] = excess[lane] > 0;
  return result;
}

std::array<int, PlaneFilter::width> PlaneFilter::apart(EventKind kind, double separation) const {
  return kind == EventKind::vertex_face ? apart<EventKind::vertex_face>(separation)
                                        : apart<EventKind::edge_edge>(separation);
}

}  // namespace stiv
