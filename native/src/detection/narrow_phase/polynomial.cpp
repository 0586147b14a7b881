// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <functional>

#include "detection/narrow_phase/bernstein.hpp"
#include "detection/narrow_phase/contact.hpp"

namespace stiv {

namespace {

/// Times are reported early by this fraction of a step, "to account for error in the root finding and response
/// computation". [P4.1]
constexpr double retreat = 0.01;
/// A root counts if the primitives are within this fraction above the threshold, apart from rounding. The conservative
/// phase reports at the same distance, so no broad phase skips a reported pair.
constexpr double tolerance = 1e-3;

using Moving = Bernstein<1, Vector3>;

/// The cubic, and the normal of the face or of both edges in it.
struct Coplanarity {
  Bernstein<3> volume;
  Bernstein<2, Vector3> normal;
};

Moving difference(const RelativeMotion<double>& motion, std::size_t a, std::size_t b) {
  const Vector3 start = motion.start[a] - motion.start[b];
  return {start, start + (motion.step[a] - motion.step[b])};
}

/// (x_0 - x_1) . [(x_2 - x_1) x (x_3 - x_1)], or (x_0 - x_2) . [(x_1 - x_0) x (x_3 - x_2)]. [Provot 1997]
Coplanarity coplanarity(const RelativeMotion<double>& motion) {
  const bool face = motion.kind == EventKind::vertex_face;
  const Moving u = face ? difference(motion, 2, 1) : difference(motion, 1, 0);
  const Moving v = face ? difference(motion, 3, 1) : difference(motion, 3, 2);
  const Moving apart = face ? difference(motion, 0, 1) : difference(motion, 0, 2);
  const auto cross = [](const Vector3& a, const Vector3& b) { return Vector3(a.cross(b)); };
  const auto dot = [](const Vector3& a, const Vector3& b) { return a.dot(b); };
  Coplanarity result;
  result.normal = multiply(u, v, cross);
  result.volume = multiply(apart, result.normal, dot);
  return result;
}

/// volume^2 - h^2 |normal|^2, zero where the vertex is at distance h from the plane of the face (or the lines of both
/// edges from each other). [P5.2]
Bernstein<6> distance_polynomial(const Coplanarity& coplanarity, double separation) {
  const auto dot = [](const Vector3& a, const Vector3& b) { return a.dot(b); };
  const Bernstein<2> one{1, 1, 1};
  const Bernstein<6> volume2 = multiply(coplanarity.volume, coplanarity.volume, std::multiplies<>());
  const Bernstein<6> normal2 =
      multiply(multiply(coplanarity.normal, coplanarity.normal, dot), one, std::multiplies<>());
  Bernstein<6> result;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = volume2[k] - separation * separation * normal2[k];
  return result;
}

/// Motion within a common plane leaves only rounding errors, whose roots mean nothing.
bool vanishes(const Bernstein<3>& volume, const RelativeMotion<double>& motion) {
  const double size = motion.rounding / Precision<double>::gap;
  for (const double coefficient : volume)
    if (std::abs(coefficient) > 64 * 0x1p-53 * size * size * size) return false;
  return true;
}

std::vector<double> times_at_distance(const RelativeMotion<double>& motion, double separation) {
  const Coplanarity polynomials = coplanarity(motion);
  if (separation > 0) return roots(distance_polynomial(polynomials, separation));
  return vanishes(polynomials.volume, motion) ? std::vector<double>() : roots(polynomials.volume);
}

/// The normal at a time, on the side that the first primitive comes from.
Vector3 side_of_approach(const RelativeMotion<double>& motion, const Witness& nearest, double time) {
  Vector3 relative = Vector3::Zero();
  for (std::size_t k = 1; k < 4; ++k) relative += nearest.weights[k] * motion.step[k];
  const Vector3 normal = geometric_normal(motion, time);
  return normal.dot(relative) > 0 ? Vector3(-normal) : normal;
}

}  // namespace

std::optional<Contact> first_contact_by_polynomial(EventKind kind, const PairMotion& motion, Proximity proximity,
                                                   double latest) {
  const RelativeMotion<double> relative(kind, motion);
  if (relative.rests()) return std::nullopt;
  const Witness at_start = witness(kind, relative.start);
  const PairClearance clearance = pair_clearance(kind, motion, proximity, at_start.distance);
  const double threshold = std::min(clearance.threshold, at_start.distance);
  double parted = 0;
  if (at_start.distance <= threshold + 4 * relative.rounding) {
    parted = parting_time(relative, at_start.distance, threshold);
    if (parted >= 1) return std::nullopt;
    if (parted == 0) {
      Contact contact = contact_of(relative, {0, at_start, Vector3::Zero()}, at_start.distance);
      contact.clearance = clearance;
      return contact;
    }
  }
  for (const double time : times_at_distance(relative, threshold)) {
    const Witness nearest = witness(kind, relative.at(time));
    if (time < parted || nearest.distance > threshold * (1 + tolerance) + 8 * relative.rounding) continue;
    const double early = std::max(0.0, time - retreat);
    if (early > latest) return std::nullopt;
    Contact contact =
        contact_of(relative, {time, nearest, side_of_approach(relative, nearest, time)}, at_start.distance);
    contact.time = early;
    contact.clearance = clearance;
    return contact;
  }
  return std::nullopt;
}

}  // namespace stiv
