// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "detection/filters/relative_motion.hpp"
#include "stiv/detection/distance.hpp"

namespace stiv {

/// Where an advancement ended: the pair is known to keep the threshold up to `time`.
template <class Scalar>
struct Approach {
  Scalar time = 0;
  WitnessOf<Scalar> witness;                                ///< at `time`
  VectorOf<Scalar> last_normal = VectorOf<Scalar>::Zero();  ///< of the last plane that separated the pair
};

/// Advances from `time`, where the pair is apart by more than the threshold, as long as separating planes show that it
/// stays so. Nothing if the pair is never within the threshold up to `latest`.
template <class Scalar>
std::optional<Approach<Scalar>> advance(const RelativeMotion<Scalar>& motion, const Scalar& threshold,
                                        const Scalar& time, double latest);

/// A time from which a pair that touches, or is at the threshold, at the start is shown to be apart by more than the
/// threshold, 1 if it slides along a plane for the whole step and comes no nearer, 0 if neither can be shown.
double parting_time(const RelativeMotion<double>& motion, double start_distance, double threshold);

}  // namespace stiv
