// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "detection/filters/pair_filters.hpp"

namespace stiv {

/// The step of a vertex as multiples of 1 / `unit`, in a frame and a scale in which no coordinate exceeds 1. Integers,
/// so that differences have no further error, however close the vertices are.
struct alignas(32) CoarseStep {
  static constexpr float unit = 0x1p29F;

  std::int32_t start[4];  ///< x, y, z, 0
  std::int32_t end[4];    ///< less the motion of the frame

  /// The largest component of the displacement.
  std::int32_t reach() const {
    std::int32_t largest = 0;
    for (std::size_t k = 0; k < 3; ++k) largest = std::max({largest, end[k] - start[k], start[k] - end[k]});
    return largest;
  }
};

/// The frame and the scale of coarse steps.
class CoarseFrame {
 public:
  CoarseFrame() = default;
  /// @param radius bound of the coordinates relative to the center, at the start and at the end
  CoarseFrame(const Vector3& centre, const Vector3& motion, double radius)
      : centre_(centre), end_centre_(centre + motion) {
    int exponent = 0;
    std::frexp(radius + motion.lpNorm<Eigen::Infinity>(), &exponent);
    is_valid_ = exponent > least_exponent;
    to_units_ = std::ldexp(static_cast<double>(CoarseStep::unit), -exponent);
  }

  /// Are products of coordinates of the scene so large that they do not underflow?
  bool is_valid() const { return is_valid_; }
  /// How many units a length has.
  double in_units(double length) const { return length * to_units_; }
  CoarseStep step(const double* start, const double* end) const {
    CoarseStep step{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Index>(k);
      step.start[k] = nearest(in_units(start[k] - centre_[axis]));
      step.end[k] = nearest(in_units(end[k] - end_centre_[axis]));
    }
    return step;
  }

 private:
  static constexpr int least_exponent = -64;

  /// The nearest integer: that of the last bits of the sum.
  static std::int32_t nearest(double value) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(value + 0x1.8p52)));
  }

  Vector3 centre_ = Vector3::Zero(), end_centre_ = Vector3::Zero();
  double to_units_ = 1;
  bool is_valid_ = false;
};

/// Those of NearbySteps in units of coarse steps, which are relative to its motion.
struct CoarseBounds {
  float clearance;  ///< of the hulls

  /// @param reach no less than that of any coarse step
  CoarseBounds(const CoarseFrame& frame, double separation, double slack, std::int32_t reach)
      : clearance(static_cast<float>(frame.in_units(separation) + 2 * slack * (reach + 1.0)) * (1 + 0x1p-20F)) {}
};

/// A bit for each pair: 1 only for pairs that find_apart_by_hulls flags too, and for nearly all of these. Takes twice
/// as many pairs at a time. Bits beyond the pairs have no meaning.
std::uint64_t find_apart_by_coarse_hulls(EventKind kind, const PairView& pairs, const CoarseStep* vertices,
                                         const CoarseBounds& bounds);

}  // namespace stiv
