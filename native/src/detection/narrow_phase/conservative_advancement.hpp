// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "detection/filters/relative_motion.hpp"
#include "stiv/detection/distance.hpp"

namespace stiv {

/// The end of an advancement: the pair provably stays beyond the threshold up to `time`.
template <class Scalar>
struct Approach {
  Scalar time = 0;
  WitnessOf<Scalar> witness;                                ///< at `time`
  VectorOf<Scalar> last_normal = VectorOf<Scalar>::Zero();  ///< of the last plane that separated the pair
};

/// Advances from `time`, where the pair is apart by more than the threshold, as long as separating planes show that it
/// stays so. Nothing if the pair is never within the threshold up to `latest`.
/// @param nearest the nearest points at `time`, if they are known
template <class Scalar>
std::optional<Approach<Scalar>> advance(const RelativeMotion<Scalar>& motion, const Scalar& threshold,
                                        const Scalar& time, double latest, const WitnessOf<Scalar>* nearest = nullptr);

/// For a pair that touches, or is at the threshold, at the start: a time from which it is provably beyond the
/// threshold. 1 if it slides along a plane for the whole step, 0 if neither can be proved.
double parting_time(const RelativeMotion<double>& motion, double start_distance, double threshold);

}  // namespace stiv
