// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/distance.hpp"

#include <cmath>
#include <limits>

#include "detection/narrow_phase/double_double.hpp"

namespace stiv {

namespace {

template <class Scalar>
using Vector = Eigen::Matrix<Scalar, 3, 1>;

/// Squared sine below which two directions count as parallel and every feature is measured instead of the region
/// that barycentric coordinates point to: these lose half their digits there.
constexpr double parallel = 1e-12;

/// The nearest of the points tried so far; `distance` is squared until `measured`.
template <class Scalar>
struct Search {
  const Quadruple<Scalar>& x;
  WitnessOf<Scalar> best{};

  explicit Search(const Quadruple<Scalar>& points) : x(points) {
    best.distance = std::numeric_limits<double>::infinity();
  }

  void try_weights(const Scalar& w0, const Scalar& w1, const Scalar& w2, const Scalar& w3) {
    const Vector<Scalar> separation = w0 * x[0] + w1 * x[1] + w2 * x[2] + w3 * x[3];
    const Scalar squared = separation.squaredNorm();
    if (squared < best.distance) best = {{w0, w1, w2, w3}, separation, squared};
  }

  WitnessOf<Scalar> measured() {
    using std::sqrt;
    best.distance = sqrt(best.distance);
    return best;
  }
};

template <class Scalar>
Scalar clamped(const Scalar& value) {
  return value > 0 ? (value < 1 ? value : Scalar(1)) : Scalar(0);
}

/// Parameter in [0, 1] of the point of segment (a, b) nearest to p; 0 for a segment without length.
template <class Scalar>
Scalar nearest_on_segment(const Vector<Scalar>& p, const Vector<Scalar>& a, const Vector<Scalar>& b) {
  const Vector<Scalar> along = b - a;
  const Scalar length2 = along.squaredNorm();
  return length2 > 0 ? clamped<Scalar>(along.dot(p - a) / length2) : Scalar(0);
}

template <class Scalar>
void try_ends(Search<Scalar>& search) {
  const auto& x = search.x;
  const Scalar a0 = nearest_on_segment<Scalar>(x[0], x[2], x[3]);
  const Scalar a1 = nearest_on_segment<Scalar>(x[1], x[2], x[3]);
  const Scalar b0 = nearest_on_segment<Scalar>(x[2], x[0], x[1]);
  const Scalar b1 = nearest_on_segment<Scalar>(x[3], x[0], x[1]);
  search.try_weights(1, 0, a0 - 1, -a0);
  search.try_weights(0, 1, a1 - 1, -a1);
  search.try_weights(1 - b0, b0, -1, 0);
  search.try_weights(1 - b1, b1, 0, -1);
}

}  // namespace

// The foot in the plane if it is inside the triangle, else the nearest of the sides that it lies beyond. If the
// triangle is too thin to trust the foot, the foot and all sides are measured: any point of the triangle bounds the
// distance from above.
template <class Scalar>
WitnessOf<Scalar> point_triangle(const Quadruple<Scalar>& x) {
  const Vector<Scalar> u = x[2] - x[1], v = x[3] - x[1], p = x[0] - x[1];
  const Vector<Scalar> normal = u.cross(v);
  const Scalar normal2 = normal.squaredNorm();
  const bool thin = !(normal2 > parallel * u.squaredNorm() * v.squaredNorm());
  const Scalar b = normal2 > 0 ? Scalar(normal.dot(p.cross(v)) / normal2) : Scalar(-1);
  const Scalar c = normal2 > 0 ? Scalar(normal.dot(u.cross(p)) / normal2) : Scalar(-1);
  Search<Scalar> search(x);
  const bool inside = b >= 0 && c >= 0 && b + c <= 1;
  if (inside) search.try_weights(1, b + c - 1, -b, -c);
  if (thin || b + c > 1) {
    const Scalar bc = nearest_on_segment<Scalar>(x[0], x[2], x[3]);
    search.try_weights(1, 0, bc - 1, -bc);
  }
  if (thin || b < 0) {
    const Scalar ca = nearest_on_segment<Scalar>(x[0], x[3], x[1]);
    search.try_weights(1, -ca, 0, ca - 1);
  }
  if (thin || c < 0) {
    const Scalar ab = nearest_on_segment<Scalar>(x[0], x[1], x[2]);
    search.try_weights(1, ab - 1, -ab, 0);
  }
  return search.measured();
}

// Ericson 5.1.9: the common perpendicular, clamped to one segment and then to the other, from there back to the first.
// Where the segments are (nearly) parallel, the perpendicular cannot be trusted, and all ends are measured.
template <class Scalar>
WitnessOf<Scalar> segment_segment(const Quadruple<Scalar>& x) {
  const Vector<Scalar> a = x[1] - x[0], b = x[3] - x[2], r = x[0] - x[2];
  const Scalar aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b), ar = a.dot(r), br = b.dot(r);
  const Scalar determinant = a.cross(b).squaredNorm();
  Search<Scalar> search(x);
  if (determinant > 0) {
    Scalar s = clamped<Scalar>((ab * br - bb * ar) / determinant);
    Scalar u = (ab * s + br) / bb;
    if (u < 0 || u > 1) {
      u = clamped(u);
      s = clamped<Scalar>((ab * u - ar) / aa);
    } else if (s > 0 && s < 1) {
      u = (aa * br - ab * ar) / determinant;  // the perpendicular itself, directly from the determinant
      u = clamped(u);
    }
    search.try_weights(1 - s, s, u - 1, -u);
  }
  if (!(determinant > parallel * aa * bb)) try_ends(search);
  return search.measured();
}

template WitnessOf<double> point_triangle(const Quadruple<double>&);
template WitnessOf<double> segment_segment(const Quadruple<double>&);
template WitnessOf<DoubleDouble> point_triangle(const Quadruple<DoubleDouble>&);
template WitnessOf<DoubleDouble> segment_segment(const Quadruple<DoubleDouble>&);

}  // namespace stiv
