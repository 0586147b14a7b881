// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/conservative_advancement.hpp"

#include <algorithm>
#include <cmath>

namespace stiv {

namespace {

/// Steps per pair; contacts take 2 to 6; those that touch without crossing take a fixed fraction of the wait at each.
constexpr int most_steps = 256;
/// Trials of a longer step in each step. A plane may have to turn in hundreds of parts of a step in which a triangle
/// turns by much beside another: each part holds as long as (angle)^2 times the size stays below the gap.
constexpr int most_trials = 12;
/// The advance ends within this fraction above the threshold: times are early by as much, relative to the approach.
constexpr double tolerance = 1e-3;

Vector3 direction(const Witness& witness) {
  return witness.distance > 0 ? Vector3(witness.separation / witness.distance) : Vector3(Vector3::Zero());
}

Vector3 relative_step(const RelativeMotion& motion, const Witness& witness) {
  const auto& w = witness.weights;
  return w[1] * motion.step[1] + w[2] * motion.step[2] + w[3] * motion.step[3];
}

/// When the pair would be within `threshold` (or, if never, nearest) if the nearest points stayed where they are on
/// their primitives; the end of the step if they part.
double predicted_time(const RelativeMotion& motion, const Witness& witness, double threshold, double time) {
  const Vector3 speed = relative_step(motion, witness);
  const double a = speed.squaredNorm(), b = witness.separation.dot(speed);
  if (!(b < 0)) return 1;
  const double c = witness.separation.squaredNorm() - threshold * threshold;
  const double discriminant = b * b - a * c;
  const double wait = discriminant > 0 ? c / (std::sqrt(discriminant) - b) : -b / a;
  return std::min(1.0, time + wait);
}

/// How far a plane with the direction of the nearest points at a later time, or one that turns towards it, leads.
double reach_of_trial(const RelativeMotion& motion, const Vector3& normal, double time, double trial,
                      double clearance) {
  const Witness later = witness(motion.kind, motion.at(trial));
  const Vector3 later_normal = direction(later);
  const double fixed = reach_of_plane(motion, later_normal, time, clearance);
  if (fixed >= trial || !turning_plane_holds(motion, normal, time, later_normal, trial, clearance)) return fixed;
  return reach_of_plane(motion, later_normal, trial, clearance);
}

/// The time to which planes show the pair apart, from `time` on.
double next_time(const RelativeMotion& motion, const Witness& nearest, double threshold, double time) {
  const double clearance = threshold + motion.rounding;
  const Vector3 normal = direction(nearest);
  double reached = reach_of_plane(motion, normal, time, clearance);
  const double aim = threshold * (1 + tolerance / 2) + 2 * motion.rounding;
  double trial = predicted_time(motion, nearest, aim, time);
  for (int k = 0; k < most_trials && trial > reached; ++k) {
    reached = std::max(reached, reach_of_trial(motion, normal, time, trial, clearance));
    trial = time + (trial - time) / 2;
  }
  return reached;
}

/// Directions besides that of the nearest points, which rounding spoils for pairs that are all but degenerate.
double reach_of_other_planes(const RelativeMotion& motion, double time, double clearance) {
  const Vector3 normal = geometric_normal(motion, time);
  return std::max(reach_of_plane(motion, normal, time, clearance), reach_of_plane(motion, -normal, time, clearance));
}

/// Do the boxes of both sides, in a frame of the pair, keep apart for the whole step? What a broad phase leaves out
/// must not be reported by the narrow phase where it gives up.
bool boxes_apart(const RelativeMotion& motion, double clearance) {
  for (Index axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0})
      if (reach_of_plane(motion, sign * Vector3::Unit(axis), 0, clearance) >= 1) return true;
  return false;
}

bool approaches(const RelativeMotion& motion, const Witness& witness) {
  return witness.separation.dot(relative_step(motion, witness)) < 0;
}

/// Near enough to end: within rounding of the threshold, or within the tolerance and still approaching.
bool arrived(const RelativeMotion& motion, const Witness& nearest, double threshold) {
  if (nearest.distance <= threshold + 1.25 * motion.rounding) return true;
  return nearest.distance <= threshold * (1 + tolerance) && approaches(motion, nearest);
}

}  // namespace

// A plane through the nearest points leads at least as far as the step of additive CCD, (distance - threshold) over
// the sum of speeds, and for pairs that slide past each other much further; so planes are all that is used. The safety
// of the result rests on the planes alone: a poor direction costs steps, never correctness.
std::optional<Approach> advance(const RelativeMotion& motion, double threshold, double time, double latest) {
  const double clearance = threshold + motion.rounding;
  Approach approach{time, {}, Vector3::Zero()};
  for (int step = 0; step < most_steps; ++step) {
    approach.witness = witness(motion.kind, motion.at(approach.time));
    if (arrived(motion, approach.witness, threshold)) return approach;
    double reached = next_time(motion, approach.witness, threshold, approach.time);
    if (reached <= approach.time) reached = reach_of_other_planes(motion, approach.time, clearance);
    if (reached >= 1 || reached > latest) return std::nullopt;
    if (reached <= approach.time) break;
    approach.last_normal = direction(approach.witness);
    approach.time = reached;
  }
  if (boxes_apart(motion, clearance)) return std::nullopt;
  approach.witness = witness(motion.kind, motion.at(approach.time));
  return approach;
}

double parting_time(const RelativeMotion& motion, double threshold) {
  const double touching = -motion.rounding, apart = threshold + motion.rounding;
  for (const double time : {0.0, 1.0}) {
    const Vector3 normal = geometric_normal(motion, time);
    if (normal.isZero(0)) continue;
    for (const Vector3& side : {normal, Vector3(-normal)})
      if (gap_of_plane(motion, side, 0) >= touching && gap_of_plane(motion, side, 1) >= touching) return 1;
  }
  for (double time = 1; time > 0x1p-24; time /= 2) {
    const Vector3 normal = direction(witness(motion.kind, motion.at(time)));
    if (gap_of_plane(motion, normal, 0) >= touching && gap_of_plane(motion, normal, time) >= apart) return time;
  }
  return 0;
}

}  // namespace stiv
