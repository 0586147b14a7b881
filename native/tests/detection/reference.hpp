// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "stiv/detection/narrow_phase.hpp"

namespace stiv::reference {

using Real = long double;
using Point = Eigen::Matrix<Real, 3, 1>;
using Points = std::array<Point, 4>;

inline Real to_segment(const Point& p, const Point& a, const Point& b) {
  const Point along = b - a;
  const Real length2 = along.squaredNorm();
  const Real s = length2 > 0 ? std::clamp<Real>(along.dot(p - a) / length2, 0, 1) : 0;
  return (a + s * along - p).norm();
}

/// Distance of two primitives by a method independent of the library's: it projects the interior on an orthonormal
/// frame, always measures the whole boundary, and uses extended arithmetic.
inline Real distance(EventKind kind, const Points& x) {
  const bool face = kind == EventKind::vertex_face;
  const Point u = face ? Point(x[2] - x[1]) : Point(x[1] - x[0]);
  const Point v = face ? Point(x[3] - x[1]) : Point(x[3] - x[2]);
  Real best = face
                  ? std::min({to_segment(x[0], x[1], x[2]), to_segment(x[0], x[2], x[3]), to_segment(x[0], x[3], x[1])})
                  : std::min({to_segment(x[0], x[2], x[3]), to_segment(x[1], x[2], x[3]), to_segment(x[2], x[0], x[1]),
                              to_segment(x[3], x[0], x[1])});
  if (u.norm() == 0) return best;
  const Point e = u.normalized();
  Point f = v - v.dot(e) * e;
  if (f.norm() <= 1e-15L * v.norm() || f.norm() == 0) return best;
  f.normalize();
  const Point n = e.cross(f);
  if (face) {
    const Point r = x[0] - x[1];
    const Real c = r.dot(f) / v.dot(f), b = (r.dot(e) - c * v.dot(e)) / u.dot(e);
    if (b >= 0 && c >= 0 && b + c <= 1) best = std::min(best, std::abs(r.dot(n)));
  } else {
    const Point r = x[2] - x[0];
    const Real t = -r.dot(f) / v.dot(f), s = (r.dot(e) + t * v.dot(e)) / u.dot(e);
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, std::abs(r.dot(n)));
  }
  return best;
}

inline Points at(const PairMotion& motion, Real t) {
  Points x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = (1 - t) * motion.start[k].cast<Real>() + t * motion.end[k].cast<Real>();
  return x;
}

/// Largest speed of any point of one side relative to any point of the other.
inline Real speed_bound(EventKind kind, const PairMotion& motion) {
  const auto first = static_cast<std::size_t>(first_side_size(kind));
  Real speed = 0;
  for (std::size_t i = 0; i < first; ++i)
    for (std::size_t j = first; j < 4; ++j) {
      const Point a = motion.end[i].cast<Real>() - motion.start[i].cast<Real>();
      const Point b = motion.end[j].cast<Real>() - motion.start[j].cast<Real>();
      speed = std::max(speed, (a - b).norm());
    }
  return speed;
}

struct Answer {
  Real time = std::numeric_limits<Real>::infinity();   ///< first sampled time within the threshold
  Real least = std::numeric_limits<Real>::infinity();  ///< least distance sampled
};

/// First time within `threshold` by bisection, without intervals that the speed bound rules out. Every result is a true
/// contact, and no contact that lasts longer than `resolution` is missed.
inline void search(EventKind kind, const PairMotion& motion, Real threshold, Real speed, Real t0, Real t1,
                   Real resolution, Answer& answer) {
  if (answer.time <= t0) return;
  const Real middle = (t0 + t1) / 2, d = distance(kind, at(motion, middle));
  answer.least = std::min(answer.least, d);
  if (d <= threshold) answer.time = std::min(answer.time, middle);
  if (d - speed * (t1 - t0) / 2 > threshold || t1 - t0 < resolution) return;
  search(kind, motion, threshold, speed, t0, middle, resolution, answer);
  search(kind, motion, threshold, speed, middle, t1, resolution, answer);
}

inline Answer first_time(EventKind kind, const PairMotion& motion, Real threshold, Real resolution) {
  Answer answer;
  const Real d0 = distance(kind, at(motion, 0)), d1 = distance(kind, at(motion, 1));
  answer.least = std::min(d0, d1);
  if (d0 <= threshold) answer.time = 0;
  if (d1 <= threshold) answer.time = std::min<Real>(answer.time, 1);
  search(kind, motion, threshold, speed_bound(kind, motion), 0, 1, resolution, answer);
  return answer;
}

}  // namespace stiv::reference
