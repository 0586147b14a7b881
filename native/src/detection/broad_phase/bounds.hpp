// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <limits>

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

/// A box and whether anything in it is active, as eight numbers whose minima give the union: the low
/// corner, the negated high corner, -1 if active or else 1, and padding.
struct alignas(32) PackedBox {
  std::array<float, 8> values;

  static PackedBox empty() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return {{infinity, infinity, infinity, infinity, infinity, infinity, 1, 0}};
  }
  /// Clamps to finite numbers, so that no sum of a low and a negated high is undefined.
  static PackedBox of(const Bounds& box, bool active) {
    constexpr float least = std::numeric_limits<float>::lowest();
    PackedBox packed{{box.low[0], box.low[1], box.low[2], -box.high[0], -box.high[1], -box.high[2]}};
    for (float& value : packed.values) value = std::max(value, least);
    packed.values[6] = active ? -1.0F : 1.0F;
    return packed;
  }

  Bounds bounds() const { return {{values[0], values[1], values[2]}, {-values[3], -values[4], -values[5]}}; }

  bool active() const { return values[6] < 0; }

  void include(const PackedBox& other) {
    for (std::size_t k = 0; k < 8; ++k) values[k] = other.values[k] < values[k] ? other.values[k] : values[k];
  }
  /// Does it contain the other box, and is it active if the other is?
  bool contains(const PackedBox& other) const {
    bool inside = true;
    for (std::size_t k = 0; k < 7; ++k) inside &= values[k] <= other.values[k];
    return inside;
  }
};

/// Do the boxes overlap, and is one of them active? The sum of a low and a negated high is a difference with the right
/// sign; of an empty box it is infinite, and the result false.
inline bool may_meet(const PackedBox& a, const PackedBox& b) {
  bool near = a.active() || b.active();
  for (std::size_t k = 0; k < 3; ++k)
    near &= (a.values[k] + b.values[k + 3] <= 0) & (b.values[k] + a.values[k + 3] <= 0);
  return near;
}

}  // namespace stiv
