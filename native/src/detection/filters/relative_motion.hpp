// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "detection/narrow_phase/double_double.hpp"
#include "stiv/detection/distance.hpp"
#include "stiv/detection/narrow_phase.hpp"

namespace stiv {

template <class Scalar>
using VectorOf = Eigen::Matrix<Scalar, 3, 1>;

/// A pair relative to its first vertex, which thus rests at the origin. Motion common to all four vertices vanishes
/// (exactly if the displacements are equal), and so does the rounding error of a far origin.
template <class Scalar>
struct RelativeMotion {
  RelativeMotion(EventKind event_kind, const PairMotion& motion);

  Quadruple<Scalar> at(const Scalar& time) const;
  bool rests() const;

  EventKind kind;
  Quadruple<Scalar> start;  ///< x_k - x_0, without negative zeros: the same bits as at(0)
  Quadruple<Scalar> step;   ///< displacement of x_k less that of x_0

  /// Bound of the rounding error of a projected gap. [docs/mathematics.md, "Continuous detection"]
  Scalar rounding;
};

/// The vertices along a direction: n.x_k at the start, and its change in the step.
template <class Scalar>
struct ProjectedMotion {
  ProjectedMotion(const RelativeMotion<Scalar>& motion, const VectorOf<Scalar>& normal);

  EventKind kind;
  std::array<Scalar, 4> offset, rate;
};

/// A plane with unit normal n separates the sides by g(t) = min n.(x_i(t) - x_j(t)) over i of the first side and j of
/// the second. Each term is linear in time, so g is concave: true at both ends of an interval means true within.
/// Returns the largest time, at most 1, such that g >= clearance from `time` until then; `time` if it fails there.
template <class Scalar>
Scalar reach_of_plane(const ProjectedMotion<Scalar>& along_normal, const Scalar& time, const Scalar& clearance);
template <class Scalar>
Scalar reach_of_plane(const RelativeMotion<Scalar>& motion, const VectorOf<Scalar>& normal, const Scalar& time,
                      const Scalar& clearance) {
  return reach_of_plane(ProjectedMotion<Scalar>(motion, normal), time, clearance);
}

/// The same for a plane whose normal turns linearly from n0 to n1 (it is never longer than one in between) while the
/// vertices move from x0 to x1: n(t).(x_i - x_j)(t) is quadratic, and its Bernstein coefficients bound it from below.
/// True if all keep clearance.
template <class Scalar>
bool turning_plane_holds(EventKind kind, const VectorOf<Scalar>& n0, const Quadruple<Scalar>& x0,
                         const VectorOf<Scalar>& n1, const Quadruple<Scalar>& x1, const Scalar& clearance);

/// g of a plane at a time.
template <class Scalar>
Scalar gap_of_plane(const RelativeMotion<Scalar>& motion, const VectorOf<Scalar>& normal, const Scalar& time);

/// Do the nearest points lie inside face, vertex and edges, away from all ends and sides?
template <class Scalar>
bool within_both(const WitnessOf<Scalar>& nearest) {
  for (const Scalar& weight : nearest.weights)
    if (weight == 0) return false;
  return true;
}

/// Unit normal of the triangle, or of the plane spanned by both edges; zero where it is degenerate.
template <class Scalar>
VectorOf<Scalar> geometric_normal(EventKind kind, const Quadruple<Scalar>& x);
template <class Scalar>
VectorOf<Scalar> geometric_normal(const RelativeMotion<Scalar>& motion, const Scalar& time) {
  return geometric_normal<Scalar>(motion.kind, motion.at(time));
}

}  // namespace stiv
