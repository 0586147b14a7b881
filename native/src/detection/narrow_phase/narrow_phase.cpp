// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/narrow_phase.hpp"

#include <algorithm>
#include <cmath>

#include "detection/narrow_phase/contact.hpp"
#include "detection/narrow_phase/near_miss.hpp"

namespace stiv {

namespace {

/// Do the sides clearly pass through each other where the advance ended? They do if, a moment later, the nearest points
/// lie inside both primitives, and past each other by more than rounding.
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

/// The largest double that is not above.
double rounded_down(const DoubleDouble& value) {
  return value.low < 0 ? std::nextafter(value.high, -never) : value.high;
}

/// An approach in double-doubles, with its nearest points in doubles.
Approach<double> rounded(const RelativeMotion<double>& motion, const Approach<DoubleDouble>& approach) {
  const double time = rounded_down(approach.time);
  const VectorOf<DoubleDouble>& n = approach.last_normal;
  return {time, witness(motion.kind, motion.at(time)), Vector3(n[0].high, n[1].high, n[2].high)};
}

/// Repeats in double-doubles a contact that doubles cannot distinguish from a near miss. Called only if the threshold
/// is within rounding, and not for the many pairs that clearly cross.
std::optional<Approach<double>> refined(const RelativeMotion<double>& motion, const PairMotion& pair, double threshold,
                                        const Approach<double>& approach) {
  constexpr double noticeable = 1024;
  if (threshold > noticeable * motion.rounding || crosses(motion, approach)) return approach;
  const RelativeMotion<DoubleDouble> finer(motion.kind, pair);
  if (slips_past(finer, threshold, approach)) return std::nullopt;
  const auto found = advance<DoubleDouble>(finer, threshold, approach.time, 1);
  if (!found) return std::nullopt;
  Approach<double> nearer = rounded(motion, *found);
  if (nearer.last_normal.isZero(0)) nearer.last_normal = approach.last_normal;
  return nearer;
}

bool starts_within(EventKind kind, const PairMotion& motion, const RelativeMotion<double>& relative,
                   double separation) {
  const double distance = witness(kind, relative.start).distance;
  if (distance > separation + 4 * relative.rounding) return false;
  if (distance <= separation - 4 * relative.rounding) return true;
  const RelativeMotion<DoubleDouble> finer(kind, motion);
  return witness(kind, finer.start).distance <= DoubleDouble(separation) + 4 * finer.rounding;
}

/// Is the distance at the start clear of rounding there, but not of the rounding of a motion that is far longer?
/// [docs/mathematics.md, "Touching at the start"]
bool is_lost_in_motion(const RelativeMotion<double>& motion, double distance) {
  constexpr double clear = 1024;
  if (distance > 8 * motion.rounding) return false;
  double size = 0;
  for (const Vector3& x : motion.start) size = std::max(size, x.cwiseAbs().maxCoeff());
  return distance > clear * Precision<double>::gap * size;
}

/// The contact of a pair that is lost in its motion, in double-doubles: doubles cannot tell on which side it starts.
std::optional<Contact> contact_of_long_motion(double threshold, const RelativeMotion<double>& relative,
                                              const PairMotion& motion, const Witness& at_start, double latest) {
  const RelativeMotion<DoubleDouble> finer(relative.kind, motion);
  const bool is_lost_again = DoubleDouble(at_start.distance - threshold) <= 8 * finer.rounding;
  if (is_lost_again) return contact_of(relative, {0, at_start, Vector3::Zero()}, at_start.distance);
  const auto found = advance<DoubleDouble>(finer, threshold, 0, latest);
  if (!found) return std::nullopt;
  return contact_of(relative, rounded(relative, *found), at_start.distance);
}

std::optional<Contact> contact_within(double threshold, const RelativeMotion<double>& relative,
                                      const PairMotion& motion, const Witness& at_start, double latest) {
  double time = 0;
  if (is_lost_in_motion(relative, at_start.distance))
    return contact_of_long_motion(threshold, relative, motion, at_start, latest);
  if (at_start.distance <= threshold + 4 * relative.rounding) {
    time = parting_time(relative, at_start.distance, threshold);
    if (time >= 1) return std::nullopt;
    if (time == 0) return contact_of(relative, {0, at_start, Vector3::Zero()}, at_start.distance);
  }
  std::optional<Approach<double>> approach =
      advance(relative, threshold, time, latest, time == 0 ? &at_start : nullptr);
  if (approach) approach = refined(relative, motion, threshold, *approach);
  if (!approach || approach->time > latest) return std::nullopt;
  return contact_of(relative, *approach, at_start.distance);
}

}  // namespace

std::optional<Contact> first_contact(EventKind kind, const PairMotion& motion, Proximity proximity, double latest) {
  const RelativeMotion<double> relative(kind, motion);
  if (relative.rests()) return std::nullopt;
  const Witness at_start = witness(kind, relative.start);
  const double largest = std::min(proximity.separation, at_start.distance);  // bounds any threshold
  std::optional<Contact> contact;
  if (proximity.is_apart(at_start.distance)) {
    contact = contact_within(largest, relative, motion, at_start, latest);
    if (!contact) return std::nullopt;  // the distance at the reference is asked only where it matters
  }
  const PairClearance clearance = pair_clearance(kind, motion, proximity, at_start.distance);
  const double threshold = std::min(clearance.threshold, at_start.distance);
  if (!contact || threshold < largest) contact = contact_within(threshold, relative, motion, at_start, latest);
  if (contact) contact->clearance = clearance;
  return contact;
}

double time_of_impact(EventKind kind, const PairMotion& motion, double separation) {
  const RelativeMotion<double> relative(kind, motion);
  if (starts_within(kind, motion, relative, separation)) return 0;
  if (relative.rests()) return never;
  std::optional<Approach<double>> approach = advance(relative, separation, 0.0, 1);
  if (approach) approach = refined(relative, motion, separation, *approach);
  return approach ? approach->time : never;
}

}  // namespace stiv
