// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/relative_motion.hpp"

#include <algorithm>

namespace stiv {

namespace {

using Values = std::array<double, 4>;

Values project(const Vector3& normal, const std::array<Vector3, 4>& x) {
  return {normal.dot(x[0]), normal.dot(x[1]), normal.dot(x[2]), normal.dot(x[3])};
}

/// min over pairs across the sides of p_i - p_j.
double gap(EventKind kind, const Values& p) {
  if (kind == EventKind::vertex_face) return p[0] - std::max({p[1], p[2], p[3]});
  return std::min(p[0], p[1]) - std::max(p[2], p[3]);
}

}  // namespace

// With u = 2^-53 and M the largest coordinate: coordinates here carry u M, displacements 4 u M, projections on a unit
// normal 7 u M and 18 u M, a projection at a time 34 u M, the gap of two of them 80 u M; the normal's length, the
// division that yields a time and the Bernstein average add less than 48 u M. [docs/mathematics.md]
RelativeMotion::RelativeMotion(EventKind event_kind, const PairMotion& motion) : kind(event_kind) {
  double magnitude = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    start[k] = motion.start[k] - motion.start[0];
    const Vector3 end = motion.end[k] - motion.end[0];
    step[k] = end - start[k];
    magnitude = std::max({magnitude, start[k].cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()});
  }
  rounding = 0x1p-46 * magnitude;
}

std::array<Vector3, 4> RelativeMotion::at(double time) const {
  return {start[0] + time * step[0], start[1] + time * step[1], start[2] + time * step[2], start[3] + time * step[3]};
}

bool RelativeMotion::rests() const { return step[1].isZero(0) && step[2].isZero(0) && step[3].isZero(0); }

double reach_of_plane(const RelativeMotion& motion, const Vector3& normal, double time, double clearance) {
  const Values offset = project(normal, motion.start), rate = project(normal, motion.step);
  const auto first = static_cast<std::size_t>(first_side_size(motion.kind));
  double limit = 1;
  for (std::size_t i = 0; i < first; ++i)
    for (std::size_t j = first; j < 4; ++j) {
      const double distance = offset[i] - offset[j], speed = rate[i] - rate[j];
      if (!(distance + time * speed >= clearance)) return time;
      if (speed < 0) limit = std::min(limit, (clearance - distance) / speed);
    }
  return std::max(time, limit);
}

bool turning_plane_holds(const RelativeMotion& motion, const Vector3& n0, double t0, const Vector3& n1, double t1,
                         double clearance) {
  const std::array<Vector3, 4> x0 = motion.at(t0), x1 = motion.at(t1);
  if (!(gap(motion.kind, project(n0, x0)) >= clearance)) return false;
  if (!(gap(motion.kind, project(n1, x1)) >= clearance)) return false;
  const Values a = project(n0, x1), b = project(n1, x0);
  return gap(motion.kind, {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]}) / 2 >= clearance;
}

double gap_of_plane(const RelativeMotion& motion, const Vector3& normal, double time) {
  return gap(motion.kind, project(normal, motion.at(time)));
}

Vector3 geometric_normal(const RelativeMotion& motion, double time) {
  const std::array<Vector3, 4> x = motion.at(time);
  const bool face = motion.kind == EventKind::vertex_face;
  const Vector3 u = face ? x[2] - x[1] : x[1] - x[0], v = face ? x[3] - x[1] : x[3] - x[2];
  const Vector3 normal = u.cross(v);
  const double length = normal.norm();
  return length > 0 ? Vector3(normal / length) : Vector3(Vector3::Zero());
}

}  // namespace stiv
