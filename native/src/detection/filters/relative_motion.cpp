// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/filters/relative_motion.hpp"

#include <algorithm>
#include <type_traits>

namespace stiv {

namespace {

template <class Scalar>
using Values = std::array<Scalar, 4>;

/// The first vertex rests at the origin.
template <class Scalar>
Values<Scalar> project(const VectorOf<Scalar>& normal, const Quadruple<Scalar>& x) {
  return {Scalar(0), normal.dot(x[1]), normal.dot(x[2]), normal.dot(x[3])};
}

/// min over pairs across the sides of p_i - p_j.
template <class Scalar>
Scalar gap(EventKind kind, const Values<Scalar>& p) {
  const Scalar& most = std::max(p[2], p[3]);
  if (kind == EventKind::vertex_face) return p[0] - std::max(p[1], most);
  return std::min(p[0], p[1]) - most;
}

}  // namespace

// With u = 2^-53 and M the largest coordinate: coordinates here carry u M, displacements 4 u M, projections on a unit
// normal 7 u M and 18 u M, a projection at a time 34 u M, the gap of two of them 80 u M; the normal's length, the
// division that yields a time and the Bernstein average add less than 48 u M. [docs/mathematics.md]
template <class Scalar>
RelativeMotion<Scalar>::RelativeMotion(EventKind event_kind, const PairMotion& motion) : kind(event_kind) {
  Scalar magnitude = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    start[k] = motion.start[k].template cast<Scalar>() - motion.start[0].template cast<Scalar>();
    if constexpr (std::is_same_v<Scalar, double>) start[k].array() += 0.0;  // a negative zero becomes zero
    const VectorOf<Scalar> end = motion.end[k].template cast<Scalar>() - motion.end[0].template cast<Scalar>();
    step[k] = end - start[k];
    magnitude = std::max({magnitude, start[k].cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()});
  }
  rounding = Precision<Scalar>::gap * magnitude;
}

template <class Scalar>
Quadruple<Scalar> RelativeMotion<Scalar>::at(const Scalar& time) const {
  return {VectorOf<Scalar>::Zero(), start[1] + time * step[1], start[2] + time * step[2], start[3] + time * step[3]};
}

template <class Scalar>
bool RelativeMotion<Scalar>::rests() const {
  return step[1].isZero(0) && step[2].isZero(0) && step[3].isZero(0);
}

template <class Scalar>
ProjectedMotion<Scalar>::ProjectedMotion(const RelativeMotion<Scalar>& motion, const VectorOf<Scalar>& normal)
    : kind(motion.kind), offset(project(normal, motion.start)), rate(project(normal, motion.step)) {}

template <class Scalar>
Scalar reach_of_plane(const ProjectedMotion<Scalar>& along_normal, const Scalar& time, const Scalar& clearance) {
  const auto& [kind, offset, rate] = along_normal;
  const auto first = static_cast<std::size_t>(first_side_size(kind));
  Scalar limit = 1;
  for (std::size_t i = 0; i < first; ++i)
    for (std::size_t j = first; j < 4; ++j) {
      const Scalar distance = offset[i] - offset[j], speed = rate[i] - rate[j];
      if (!(distance + time * speed >= clearance)) return time;
      if (speed < 0) limit = std::min(limit, (clearance - distance) / speed);
    }
  return std::max(time, limit);
}

template <class Scalar>
bool turning_plane_holds(EventKind kind, const VectorOf<Scalar>& n0, const Quadruple<Scalar>& x0,
                         const VectorOf<Scalar>& n1, const Quadruple<Scalar>& x1, const Scalar& clearance) {
  if (!(gap(kind, project(n0, x0)) >= clearance)) return false;
  if (!(gap(kind, project(n1, x1)) >= clearance)) return false;
  const Values<Scalar> a = project(n0, x1), b = project(n1, x0);
  return gap<Scalar>(kind, {Scalar(0), a[1] + b[1], a[2] + b[2], a[3] + b[3]}) / 2 >= clearance;
}

template <class Scalar>
Scalar gap_of_plane(const RelativeMotion<Scalar>& motion, const VectorOf<Scalar>& normal, const Scalar& time) {
  return gap(motion.kind, project(normal, motion.at(time)));
}

template <class Scalar>
VectorOf<Scalar> geometric_normal(EventKind kind, const Quadruple<Scalar>& x) {
  const bool face = kind == EventKind::vertex_face;
  const VectorOf<Scalar> u = face ? x[2] - x[1] : x[1] - x[0], v = face ? x[3] - x[1] : x[3] - x[2];
  const VectorOf<Scalar> normal = u.cross(v);
  const Scalar length = normal.norm();
  return length > 0 ? VectorOf<Scalar>(normal / length) : VectorOf<Scalar>(VectorOf<Scalar>::Zero());
}

template struct RelativeMotion<double>;
template struct ProjectedMotion<double>;
template double reach_of_plane(const ProjectedMotion<double>&, const double&, const double&);
template bool turning_plane_holds(EventKind, const VectorOf<double>&, const Quadruple<double>&, const VectorOf<double>&,
                                  const Quadruple<double>&, const double&);
template double gap_of_plane(const RelativeMotion<double>&, const VectorOf<double>&, const double&);
template VectorOf<double> geometric_normal(EventKind, const Quadruple<double>&);

template struct RelativeMotion<DoubleDouble>;
template struct ProjectedMotion<DoubleDouble>;
template DoubleDouble reach_of_plane(const ProjectedMotion<DoubleDouble>&, const DoubleDouble&, const DoubleDouble&);
template bool turning_plane_holds(EventKind, const VectorOf<DoubleDouble>&, const Quadruple<DoubleDouble>&,
                                  const VectorOf<DoubleDouble>&, const Quadruple<DoubleDouble>&, const DoubleDouble&);
template DoubleDouble gap_of_plane(const RelativeMotion<DoubleDouble>&, const VectorOf<DoubleDouble>&,
                                   const DoubleDouble&);
template VectorOf<DoubleDouble> geometric_normal(EventKind, const Quadruple<DoubleDouble>&);

}  // namespace stiv
