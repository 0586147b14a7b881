// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/narrow_phase/contact.hpp"

namespace stiv {

namespace {

/// Unit direction of contact. If the nearest points (nearly) coincide, their difference is noise: then the normal of
/// the face or of both edges, or else the last plane that separated the pair.
Vector3 contact_direction(const RelativeMotion<double>& motion, const Approach<double>& approach) {
  const Witness& nearest = approach.witness;
  constexpr double noise = 1024;
  if (nearest.distance > noise * motion.rounding) return nearest.separation / nearest.distance;
  const Vector3 normal = geometric_normal(motion, approach.time);
  if (within_both(nearest) && !normal.isZero(0)) {
    const Vector3& side = approach.last_normal;
    return normal.dot(side) < 0 ? Vector3(-normal) : normal;
  }
  return approach.last_normal;
}

}  // namespace

Contact contact_of(const RelativeMotion<double>& motion, const Approach<double>& approach, double start_distance) {
  Contact contact{approach.time, approach.witness.weights, contact_direction(motion, approach), start_distance, {}};
  Vector3 relative = Vector3::Zero();
  for (std::size_t k = 1; k < 4; ++k) relative += contact.weights[k] * motion.step[k];
  const double approach_speed = -contact.normal.dot(relative);
  if (approach_speed > 0) return contact;
  // If the pair touches at the start, only the motion distinguishes the sides. Otherwise the sides are known, and a
  // pair that moves apart at the time where the search gave up gets no direction.
  const bool touched_at_start = approach.last_normal.isZero(0) && start_distance <= 4 * motion.rounding;
  if (touched_at_start)
    contact.normal = approach_speed < 0 ? Vector3(-contact.normal) : Vector3(-relative.stableNormalized());
  else if (approach_speed < 0)
    contact.normal.setZero();
  return contact;
}

PairClearance pair_clearance(EventKind kind, const PairMotion& motion, const Proximity& proximity,
                             double start_distance) {
  if (!motion.reference || *motion.reference == motion.start) return proximity.clearance(start_distance);
  const PairMotion at_reference{*motion.reference, *motion.reference};
  return proximity.clearance(witness(kind, RelativeMotion<double>(kind, at_reference).start).distance);
}

}  // namespace stiv
