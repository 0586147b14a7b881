// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/distance.hpp"

#include <algorithm>

#include "detection/double_double.hpp"

namespace stiv {

namespace {

template <class Scalar>
using Vector = Eigen::Matrix<Scalar, 3, 1>;

/// Squared sine below which two directions count as parallel and every feature is measured instead of the region
/// that barycentric coordinates point to: these lose half their digits there.
constexpr double parallel = 1e-12;

template <class Scalar>
WitnessOf<Scalar> at_weights(const Quadruple<Scalar>& x, const std::array<Scalar, 4>& weights) {
  WitnessOf<Scalar> witness{weights, weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2] + weights[3] * x[3], 0};
  witness.distance = witness.separation.norm();
  return witness;
}

/// Parameter in [0, 1] of the point of segment (a, b) nearest to p; 0 for a segment without length.
template <class Scalar>
Scalar nearest_on_segment(const Vector<Scalar>& p, const Vector<Scalar>& a, const Vector<Scalar>& b) {
  const Vector<Scalar> along = b - a;
  const Scalar length2 = along.squaredNorm();
  return length2 > 0 ? std::clamp<Scalar>(along.dot(p - a) / length2, 0.0, 1.0) : Scalar(0.0);
}

template <class Scalar>
void keep_nearer(WitnessOf<Scalar>& best, const WitnessOf<Scalar>& other) {
  if (other.distance < best.distance) best = other;
}

template <class Scalar>
WitnessOf<Scalar> point_to_sides(const Quadruple<Scalar>& x) {
  const Scalar ab = nearest_on_segment<Scalar>(x[0], x[1], x[2]);
  const Scalar bc = nearest_on_segment<Scalar>(x[0], x[2], x[3]);
  const Scalar ca = nearest_on_segment<Scalar>(x[0], x[3], x[1]);
  WitnessOf<Scalar> best = at_weights<Scalar>(x, {1, ab - 1, -ab, 0});
  keep_nearer(best, at_weights<Scalar>(x, {1, 0, bc - 1, -bc}));
  keep_nearer(best, at_weights<Scalar>(x, {1, -ca, 0, ca - 1}));
  return best;
}

template <class Scalar>
WitnessOf<Scalar> ends_to_segments(const Quadruple<Scalar>& x) {
  const Scalar a0 = nearest_on_segment<Scalar>(x[0], x[2], x[3]);
  const Scalar a1 = nearest_on_segment<Scalar>(x[1], x[2], x[3]);
  const Scalar b0 = nearest_on_segment<Scalar>(x[2], x[0], x[1]);
  const Scalar b1 = nearest_on_segment<Scalar>(x[3], x[0], x[1]);
  WitnessOf<Scalar> best = at_weights<Scalar>(x, {1, 0, a0 - 1, -a0});
  keep_nearer(best, at_weights<Scalar>(x, {0, 1, a1 - 1, -a1}));
  keep_nearer(best, at_weights<Scalar>(x, {1 - b0, b0, -1, 0}));
  keep_nearer(best, at_weights<Scalar>(x, {1 - b1, b1, 0, -1}));
  return best;
}

template <class Scalar>
bool inside(const Scalar& value) {
  return value >= 0 && value <= 1;
}

}  // namespace

// The foot in the plane where it falls within the triangle, else the nearest of the sides. Where the triangle is so
// thin that the foot cannot be trusted, both are measured: any point of the triangle bounds the distance from above.
template <class Scalar>
WitnessOf<Scalar> point_triangle(const Quadruple<Scalar>& x) {
  const Vector<Scalar> u = x[2] - x[1], v = x[3] - x[1], p = x[0] - x[1];
  const Vector<Scalar> normal = u.cross(v);
  const Scalar normal2 = normal.squaredNorm();
  if (normal2 > 0) {
    const Scalar b = normal.dot(p.cross(v)) / normal2;
    const Scalar c = normal.dot(u.cross(p)) / normal2;
    if (b >= 0 && c >= 0 && b + c <= 1) {
      WitnessOf<Scalar> foot = at_weights<Scalar>(x, {1, b + c - 1, -b, -c});
      if (normal2 <= parallel * u.squaredNorm() * v.squaredNorm()) keep_nearer(foot, point_to_sides(x));
      return foot;
    }
  }
  return point_to_sides(x);
}

// The common perpendicular where it meets both segments, else the nearest of the four ends to the other segment.
template <class Scalar>
WitnessOf<Scalar> segment_segment(const Quadruple<Scalar>& x) {
  const Vector<Scalar> a = x[1] - x[0], b = x[3] - x[2], r = x[0] - x[2];
  const Scalar aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
  const Scalar determinant = a.cross(b).squaredNorm();
  if (determinant > 0) {
    const Scalar s = (ab * b.dot(r) - bb * a.dot(r)) / determinant;
    const Scalar u = (aa * b.dot(r) - ab * a.dot(r)) / determinant;
    if (inside(s) && inside(u)) {
      WitnessOf<Scalar> perpendicular = at_weights<Scalar>(x, {1 - s, s, u - 1, -u});
      if (determinant <= parallel * aa * bb) keep_nearer(perpendicular, ends_to_segments(x));
      return perpendicular;
    }
  }
  return ends_to_segments(x);
}

template WitnessOf<double> point_triangle(const Quadruple<double>&);
template WitnessOf<double> segment_segment(const Quadruple<double>&);
template WitnessOf<DoubleDouble> point_triangle(const Quadruple<DoubleDouble>&);
template WitnessOf<DoubleDouble> segment_segment(const Quadruple<DoubleDouble>&);

}  // namespace stiv
