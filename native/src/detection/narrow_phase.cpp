// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/narrow_phase.hpp"

#include <cmath>

#include "detection/conservative_advancement.hpp"

namespace stiv {

namespace {

/// Unit direction of contact. Where the nearest points (all but) coincide, their difference is noise: then the normal
/// of the face or of both edges, or else the last plane that separated the pair.
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

Contact contact_of(const RelativeMotion<double>& motion, const Approach<double>& approach, double start_distance) {
  Contact contact{approach.time, approach.witness.weights, contact_direction(motion, approach), start_distance};
  Vector3 relative = Vector3::Zero();
  for (std::size_t k = 1; k < 4; ++k) relative += contact.weights[k] * motion.step[k];
  const double approach_speed = -contact.normal.dot(relative);
  if (approach_speed > 0) return contact;
  // From a touching start nothing tells the sides apart but the motion. Elsewhere the sides are known, and a pair that
  // parts at the time where the search gave up has no direction to be pushed in.
  const bool touched_at_start = approach.last_normal.isZero(0) && start_distance <= 4 * motion.rounding;
  if (touched_at_start)
    contact.normal = approach_speed < 0 ? Vector3(-contact.normal) : Vector3(-relative.stableNormalized());
  else if (approach_speed < 0)
    contact.normal.setZero();
  return contact;
}

/// Do the sides clearly go through each other where the advance ended? They do if, a moment later, the nearest points
/// lie within both and beyond each other by more than rounding.
bool crosses(const RelativeMotion<double>& motion, const Approach<double>& approach) {
  const Vector3& normal = approach.last_normal;
  Vector3 relative = Vector3::Zero();
  for (std::size_t k = 1; k < 4; ++k) relative += approach.witness.weights[k] * motion.step[k];
  const double speed = -normal.dot(relative), depth = 64 * motion.rounding;
  if (!(speed > 0)) return false;
  const double later = approach.time + (approach.witness.distance + 2 * depth) / speed;
  if (!(later <= 1)) return false;
  const Witness beyond = witness(motion.kind, motion.at(later));
  for (const double weight : beyond.weights)
    if (std::abs(weight) < 0x1p-20) return false;
  return beyond.separation.dot(normal) < -depth;
}

/// Is a pair that doubles could not tell from a contact shown apart by twice the digits? Only asked where all of the
/// threshold is within rounding, and not of the many pairs that clearly cross.
bool apart_after_all(const RelativeMotion<double>& motion, const PairMotion& pair, double threshold,
                     const Approach<double>& approach, double latest) {
  constexpr double noticeable = 1024;
  if (threshold > noticeable * motion.rounding || crosses(motion, approach)) return false;
  const RelativeMotion<DoubleDouble> finer(motion.kind, pair);
  return !advance<DoubleDouble>(finer, threshold, approach.time, latest);
}

bool starts_within(EventKind kind, const PairMotion& motion, const RelativeMotion<double>& relative,
                   double separation) {
  const double distance = witness(kind, relative.start).distance;
  if (distance > separation + 4 * relative.rounding) return false;
  if (distance <= separation - 4 * relative.rounding) return true;
  const RelativeMotion<DoubleDouble> finer(kind, motion);
  return witness(kind, finer.start).distance <= DoubleDouble(separation) + 4 * finer.rounding;
}

}  // namespace

std::optional<Contact> first_contact(EventKind kind, const PairMotion& motion, Proximity proximity, double latest) {
  const RelativeMotion<double> relative(kind, motion);
  if (relative.rests()) return std::nullopt;
  const Witness at_start = witness(kind, relative.start);
  const double threshold = proximity.threshold(at_start.distance);
  double time = 0;
  if (at_start.distance <= threshold + 4 * relative.rounding) {
    time = parting_time(relative, threshold);
    if (time >= 1) return std::nullopt;
    if (time == 0) return contact_of(relative, {0, at_start, Vector3::Zero()}, at_start.distance);
  }
  const std::optional<Approach<double>> approach = advance(relative, threshold, time, latest);
  if (!approach) return std::nullopt;
  return contact_of(relative, *approach, at_start.distance);
}

double time_of_impact(EventKind kind, const PairMotion& motion, double separation) {
  const RelativeMotion<double> relative(kind, motion);
  if (starts_within(kind, motion, relative, separation)) return 0;
  if (relative.rests()) return never;
  const std::optional<Approach<double>> approach = advance(relative, separation, 0.0, 1);
  if (!approach || apart_after_all(relative, motion, separation, *approach, 1)) return never;
  return approach->time;
}

}  // namespace stiv
