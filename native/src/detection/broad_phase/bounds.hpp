// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/types.hpp"

namespace stiv {

/// Axis-aligned box in single precision, rounded outward: half the memory traffic of doubles, never too small.
struct Bounds {
  std::array<float, 3> low;
  std::array<float, 3> high;

  static Bounds empty();
  /// Grow to contain a point, padded by `margin` on each side; rounding is outward.
  void include(const Eigen::Ref<const Vector3>& point, double margin);
  void include(const Bounds& other);
};

inline bool overlap(const Bounds& a, const Bounds& b) {
  return a.low[0] <= b.high[0] && b.low[0] <= a.high[0] && a.low[1] <= b.high[1] && b.low[1] <= a.high[1] &&
         a.low[2] <= b.high[2] && b.low[2] <= a.high[2];
}

}  // namespace stiv
