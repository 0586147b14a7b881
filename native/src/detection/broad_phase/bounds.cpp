// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stiv {

namespace {

/// A float not above `value`. Conversion errs by at most half a unit in the last place, which |f| 2^-23 covers; the
/// smallest denormal does so around zero.
float round_down(double value) {
  using Limits = std::numeric_limits<float>;
  if (value < static_cast<double>(Limits::lowest())) return -Limits::infinity();
  const auto nearest = static_cast<float>(std::min(value, static_cast<double>(Limits::max())));
  return nearest - (std::abs(nearest) * Limits::epsilon() + Limits::denorm_min());
}

float round_up(double value) { return -round_down(-value); }

}  // namespace

Bounds Bounds::empty() {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}

void Bounds::include(const Eigen::Ref<const Vector3>& point, double margin) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double value = point[static_cast<Index>(axis)];
    low[axis] = std::min(low[axis], round_down(value - margin));
    high[axis] = std::max(high[axis], round_up(value + margin));
  }
}

void Bounds::include(const Bounds& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(low[axis], other.low[axis]);
    high[axis] = std::max(high[axis], other.high[axis]);
  }
}

}  // namespace stiv
