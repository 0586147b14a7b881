// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/narrow_phase/conservative_advancement.hpp"

#include <algorithm>
#include <cmath>

namespace stiv {

namespace {

/// An advance of at least this many steps is slow; most end sooner.
constexpr int slow = 2;
/// The advance ends within this fraction above the threshold, so times are early by this fraction of the approach.
constexpr double tolerance = 1e-3;

/// The edge, if any, within which exactly one of the nearest points lies.
template <class Scalar>
VectorOf<Scalar> edge_of(EventKind kind, const WitnessOf<Scalar>& nearest, const Quadruple<Scalar>& x) {
  const auto& w = nearest.weights;
  const bool first = kind == EventKind::edge_edge && w[0] != 0 && w[1] != 0;
  if (first) return x[1] - x[0];
  for (const auto& [a, b] : {std::pair(2, 3), std::pair(1, 3), std::pair(1, 2)}) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    if (w[i] != 0 && w[j] != 0 && (i == 2 || kind == EventKind::vertex_face)) return x[j] - x[i];
  }
  return VectorOf<Scalar>::Zero();
}

/// A pair at a time, with its nearest points.
template <class Scalar>
struct State {
  State(const RelativeMotion<Scalar>& motion, const Scalar& at) : State(motion, at, motion.at(at)) {}
  State(const RelativeMotion<Scalar>& motion, const Scalar& at, const Quadruple<Scalar>& positions)
      : State(at, positions, witness(motion.kind, positions)) {}
  State(const Scalar& at, const Quadruple<Scalar>& positions, const WitnessOf<Scalar>& nearest_points)
      : time(at), x(positions), nearest(nearest_points) {}

  Scalar time;
  Quadruple<Scalar> x;
  WitnessOf<Scalar> nearest;
};

/// The direction between the nearest points. If they nearly coincide, their difference is noise. Inside both
/// primitives, the normal of the face or of both edges replaces it. Inside an edge, its component along the edge is
/// removed, because the far ends of the edge would turn it into distance.
template <class Scalar>
VectorOf<Scalar> direction(const RelativeMotion<Scalar>& motion, const State<Scalar>& state) {
  const WitnessOf<Scalar>& nearest = state.nearest;
  if (!(nearest.distance > 0)) return VectorOf<Scalar>::Zero();
  if (nearest.distance >= Precision<Scalar>::noise * motion.rounding) return nearest.separation / nearest.distance;
  if (within_both(nearest)) {
    const VectorOf<Scalar> normal = geometric_normal<Scalar>(motion.kind, state.x);
    if (!normal.isZero(0)) return normal.dot(nearest.separation) < 0 ? VectorOf<Scalar>(-normal) : normal;
  }
  const VectorOf<Scalar> edge = edge_of(motion.kind, nearest, state.x);
  const Scalar length2 = edge.squaredNorm();
  if (!(length2 > 0)) return nearest.separation / nearest.distance;
  const VectorOf<Scalar> across = nearest.separation - (edge.dot(nearest.separation) / length2) * edge;
  const Scalar length = across.norm();
  return length > 0 ? VectorOf<Scalar>(across / length) : VectorOf<Scalar>(VectorOf<Scalar>::Zero());
}

template <class Scalar>
VectorOf<Scalar> relative_step(const RelativeMotion<Scalar>& motion, const WitnessOf<Scalar>& witness) {
  const auto& w = witness.weights;
  return w[1] * motion.step[1] + w[2] * motion.step[2] + w[3] * motion.step[3];
}

/// When the pair would reach `threshold` (or, if never, its least distance) if the nearest points stayed in place on
/// their primitives; the end of the step if they move apart.
template <class Scalar>
Scalar predicted_time(const RelativeMotion<Scalar>& motion, const WitnessOf<Scalar>& witness, const Scalar& threshold,
                      const Scalar& time) {
  const VectorOf<Scalar> speed = relative_step(motion, witness);
  const Scalar a = speed.squaredNorm(), b = witness.separation.dot(speed);
  if (!(b < 0)) return 1;
  const Scalar c = witness.separation.squaredNorm() - threshold * threshold;
  const Scalar discriminant = b * b - a * c;
  using std::sqrt;
  const Scalar wait = discriminant > 0 ? Scalar(c / (sqrt(discriminant) - b)) : Scalar(-b / a);
  return std::min<Scalar>(1.0, time + wait);
}

/// The time until which a plane separates the pair. Its normal is the direction of the nearest points at a later time,
/// or turns toward it.
template <class Scalar>
Scalar reach_of_trial(const RelativeMotion<Scalar>& motion, const VectorOf<Scalar>& normal, const State<Scalar>& state,
                      const Scalar& trial, const Scalar& clearance) {
  const State<Scalar> later(motion, trial);
  const VectorOf<Scalar> later_normal = direction(motion, later);
  const ProjectedMotion<Scalar> projected(motion, later_normal);
  const Scalar fixed = reach_of_plane(projected, state.time, clearance);
  if (fixed >= trial || !turning_plane_holds(motion.kind, normal, state.x, later_normal, later.x, clearance))
    return fixed;
  return reach_of_plane(projected, trial, clearance);
}

/// The same by extrapolating the distance from the last step: accurate where the nearest points slide along their
/// primitives.
template <class Scalar>
Scalar extrapolated_time(const Scalar& time, const Scalar& distance, const Scalar& time_before,
                         const Scalar& distance_before, const Scalar& threshold) {
  const Scalar fall = distance_before - distance;
  if (!(fall > 0)) return time;
  return std::min<Scalar>(1.0, time + (distance - threshold) * (time - time_before) / fall);
}

/// The time until which planes separate the pair, starting at `state` with the plane of this normal. `expected`: when
/// it is expected to reach the threshold. Subtracts its trials from `budget`.
template <class Scalar>
Scalar next_time(const RelativeMotion<Scalar>& motion, const State<Scalar>& state, const VectorOf<Scalar>& normal,
                 const Scalar& clearance, const Scalar& expected, int& budget) {
  const Scalar& time = state.time;
  Scalar reached = reach_of_plane(motion, normal, time, clearance);
  Scalar trial = expected;
  for (int k = 0; k < Precision<Scalar>::most_trials && trial > reached; ++k, --budget) {
    reached = std::max(reached, reach_of_trial(motion, normal, state, trial, clearance));
    trial = time + (trial - time) / 2;
  }
  return reached;
}

/// Tries directions other than that of the nearest points, which rounding spoils for nearly degenerate pairs.
template <class Scalar>
Scalar reach_of_other_planes(const RelativeMotion<Scalar>& motion, const State<Scalar>& state,
                             const Scalar& clearance) {
  const VectorOf<Scalar> normal = geometric_normal<Scalar>(motion.kind, state.x);
  return std::max(reach_of_plane(motion, normal, state.time, clearance),
                  reach_of_plane<Scalar>(motion, -normal, state.time, clearance));
}

/// Do the boxes of both sides, in a frame of the pair, stay apart for the whole step? Where the narrow phase gives up,
/// it must not report a pair that a broad phase may skip.
template <class Scalar>
bool boxes_apart(const RelativeMotion<Scalar>& motion, const Scalar& clearance) {
  for (Index axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0})
      if (reach_of_plane<Scalar>(motion, Scalar(sign) * VectorOf<Scalar>::Unit(axis), 0, clearance) >= 1) return true;
  return false;
}

template <class Scalar>
bool approaches(const RelativeMotion<Scalar>& motion, const WitnessOf<Scalar>& witness) {
  return witness.separation.dot(relative_step(motion, witness)) < 0;
}

/// Close enough to stop: within rounding of the threshold, or within the tolerance and still approaching.
template <class Scalar>
bool arrived(const RelativeMotion<Scalar>& motion, const WitnessOf<Scalar>& nearest, const Scalar& threshold) {
  if (nearest.distance <= threshold + 8 * motion.rounding) return true;
  return nearest.distance <= threshold * (1 + tolerance) && approaches(motion, nearest);
}

}  // namespace

// A plane through the nearest points advances at least as far as a step of additive CCD, (distance - threshold) over
// the sum of speeds, and much further for pairs that slide past each other. So only planes are used. Safety depends
// only on the planes: a poor direction costs steps, never correctness.
template <class Scalar>
std::optional<Approach<Scalar>> advance(const RelativeMotion<Scalar>& motion, const Scalar& threshold,
                                        const Scalar& time, double latest, const WitnessOf<Scalar>* nearest) {
  const Scalar clearance = threshold + motion.rounding;
  const Scalar aim = threshold * (1 + tolerance / 2) + 4 * motion.rounding;
  const Quadruple<Scalar> x = motion.at(time);
  State<Scalar> state = nearest != nullptr ? State<Scalar>(time, x, *nearest) : State<Scalar>(motion, time, x);
  VectorOf<Scalar> last_normal = VectorOf<Scalar>::Zero();
  Scalar time_before = time, distance_before = 0;
  int budget = Precision<Scalar>::trials_in_all;
  for (int step = 0; step < Precision<Scalar>::most_steps && budget > 0; ++step) {
    const Scalar distance = state.nearest.distance;
    if (arrived(motion, state.nearest, threshold)) return Approach<Scalar>{state.time, state.nearest, last_normal};
    Scalar expected = predicted_time(motion, state.nearest, aim, state.time);
    if (step >= slow)
      expected = std::max(expected, extrapolated_time(state.time, distance, time_before, distance_before, aim));
    const VectorOf<Scalar> normal = direction(motion, state);
    Scalar reached = next_time(motion, state, normal, clearance, expected, budget);
    if (reached <= state.time) reached = reach_of_other_planes(motion, state, clearance);
    if (reached >= 1 || reached > latest) return std::nullopt;
    if (reached <= state.time) break;
    last_normal = normal;
    time_before = state.time;
    distance_before = distance;
    state = State<Scalar>(motion, reached);
  }
  if (boxes_apart(motion, clearance)) return std::nullopt;
  return Approach<Scalar>{state.time, state.nearest, last_normal};
}

double parting_time(const RelativeMotion<double>& motion, double start_distance, double threshold) {
  // A pair that starts at the threshold may not come nearer; one that starts touching may not cross.
  const bool at_threshold = start_distance > 8 * motion.rounding;
  const double least = (at_threshold ? std::min(start_distance, threshold) : 0) - motion.rounding;
  const double apart = threshold + motion.rounding;
  const auto slides_along = [&](const Vector3& normal) {
    return gap_of_plane(motion, normal, 0.0) >= least && gap_of_plane(motion, normal, 1.0) >= least;
  };
  for (const double time : {0.0, 1.0}) {
    const Vector3 normal = geometric_normal(motion, time);
    if (normal.isZero(0)) continue;
    if (slides_along(normal) || slides_along(-normal)) return 1;
  }
  if (at_threshold && slides_along(direction(motion, State<double>(motion, 0.0)))) return 1;
  for (double time = 1; time > 0x1p-24; time /= 2) {
    const Vector3 normal = direction(motion, State<double>(motion, time));
    if (gap_of_plane(motion, normal, 0.0) >= least && gap_of_plane(motion, normal, time) >= apart) return time;
  }
  return 0;
}

template std::optional<Approach<double>> advance(const RelativeMotion<double>&, const double&, const double&, double,
                                                 const Witness*);
template std::optional<Approach<DoubleDouble>> advance(const RelativeMotion<DoubleDouble>&, const DoubleDouble&,
                                                       const DoubleDouble&, double, const WitnessOf<DoubleDouble>*);

}  // namespace stiv
