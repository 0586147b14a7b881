// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/detection/narrow_phase.hpp"

namespace stiv {

/// A pair seen from its first vertex, which thereby rests at the origin: motion common to all four vertices vanishes
/// (exactly where the displacements are equal), and so does the rounding that a far origin brings.
struct RelativeMotion {
  RelativeMotion(EventKind event_kind, const PairMotion& motion);

  std::array<Vector3, 4> at(double time) const;
  bool rests() const;

  EventKind kind;
  std::array<Vector3, 4> start;  ///< x_k - x_0
  std::array<Vector3, 4> step;   ///< displacement of x_k less that of x_0

  /// Bound of the rounding error of a projected gap. [docs/mathematics.md, "Continuous detection"]
  double rounding;
};

/// A plane with unit normal n separates the sides by g(t) = min n.(x_i(t) - x_j(t)) over i of the first side and j of
/// the second. Each term is linear in time, so g is concave: true at both ends of an interval means true within.
/// Returns the largest time up to 1 to which the plane keeps g >= clearance from `time` on; `time` if it fails there.
double reach_of_plane(const RelativeMotion& motion, const Vector3& normal, double time, double clearance);

/// The same for a plane whose normal turns linearly from n0 at t0 to n1 at t1 (it is never longer than one in between):
/// n(t).(x_i - x_j)(t) is quadratic, and its Bernstein coefficients bound it from below. True if all keep clearance.
bool turning_plane_holds(const RelativeMotion& motion, const Vector3& n0, double t0, const Vector3& n1, double t1,
                         double clearance);

/// g of a plane at a time.
double gap_of_plane(const RelativeMotion& motion, const Vector3& normal, double time);

/// Unit normal of the triangle, or of the plane spanned by both edges; zero where it is degenerate.
Vector3 geometric_normal(const RelativeMotion& motion, double time);

}  // namespace stiv
