// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/distance.hpp"

#include <algorithm>

namespace stiv {

namespace {

using Points = std::array<Vector3, 4>;

/// Squared sine below which two directions count as parallel and every feature is measured instead of the region
/// that barycentric coordinates point to: these lose half their digits there.
constexpr double parallel = 1e-12;

Witness at_weights(const Points& x, const std::array<double, 4>& weights) {
  Witness witness{weights, weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2] + weights[3] * x[3], 0};
  witness.distance = witness.separation.norm();
  return witness;
}

/// Parameter in [0, 1] of the point of segment (a, b) nearest to p; 0 for a segment without length.
double nearest_on_segment(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 along = b - a;
  const double length2 = along.squaredNorm();
  return length2 > 0 ? std::clamp(along.dot(p - a) / length2, 0.0, 1.0) : 0.0;
}

void keep_nearer(Witness& best, const Witness& other) {
  if (other.distance < best.distance) best = other;
}

Witness point_to_sides(const Points& x) {
  const double ab = nearest_on_segment(x[0], x[1], x[2]);
  const double bc = nearest_on_segment(x[0], x[2], x[3]);
  const double ca = nearest_on_segment(x[0], x[3], x[1]);
  Witness best = at_weights(x, {1, ab - 1, -ab, 0});
  keep_nearer(best, at_weights(x, {1, 0, bc - 1, -bc}));
  keep_nearer(best, at_weights(x, {1, -ca, 0, ca - 1}));
  return best;
}

Witness ends_to_segments(const Points& x) {
  const double a0 = nearest_on_segment(x[0], x[2], x[3]);
  const double a1 = nearest_on_segment(x[1], x[2], x[3]);
  const double b0 = nearest_on_segment(x[2], x[0], x[1]);
  const double b1 = nearest_on_segment(x[3], x[0], x[1]);
  Witness best = at_weights(x, {1, 0, a0 - 1, -a0});
  keep_nearer(best, at_weights(x, {0, 1, a1 - 1, -a1}));
  keep_nearer(best, at_weights(x, {1 - b0, b0, -1, 0}));
  keep_nearer(best, at_weights(x, {1 - b1, b1, 0, -1}));
  return best;
}

bool inside(double value) { return value >= 0 && value <= 1; }

}  // namespace

// The foot in the plane where it falls within the triangle, else the nearest of the sides. Where the triangle is so
// thin that the foot cannot be trusted, both are measured: any point of the triangle bounds the distance from above.
Witness point_triangle(const Points& x) {
  const Vector3 u = x[2] - x[1], v = x[3] - x[1], p = x[0] - x[1];
  const Vector3 normal = u.cross(v);
  const double normal2 = normal.squaredNorm();
  if (normal2 > 0) {
    const double b = normal.dot(p.cross(v)) / normal2;
    const double c = normal.dot(u.cross(p)) / normal2;
    if (b >= 0 && c >= 0 && b + c <= 1) {
      Witness foot = at_weights(x, {1, b + c - 1, -b, -c});
      if (normal2 <= parallel * u.squaredNorm() * v.squaredNorm()) keep_nearer(foot, point_to_sides(x));
      return foot;
    }
  }
  return point_to_sides(x);
}

// The common perpendicular where it meets both segments, else the nearest of the four ends to the other segment.
Witness segment_segment(const Points& x) {
  const Vector3 a = x[1] - x[0], b = x[3] - x[2], r = x[0] - x[2];
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
  const double determinant = a.cross(b).squaredNorm();
  if (determinant > 0) {
    const double s = (ab * b.dot(r) - bb * a.dot(r)) / determinant;
    const double u = (aa * b.dot(r) - ab * a.dot(r)) / determinant;
    if (inside(s) && inside(u)) {
      Witness perpendicular = at_weights(x, {1 - s, s, u - 1, -u});
      if (determinant <= parallel * aa * bb) keep_nearer(perpendicular, ends_to_segments(x));
      return perpendicular;
    }
  }
  return ends_to_segments(x);
}

}  // namespace stiv
