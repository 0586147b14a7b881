// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "detection/broad_phase/bounds.hpp"

namespace stiv {

/// Added to the first six numbers of a PackedBox, so that it contains its path in another frame. None is positive.
struct BoxGrowth {
  std::array<float, 6> values{};
  bool is_none = true;

  /// Of the other group's boxes.
  BoxGrowth opposite() const { return {{values[3], values[4], values[5], values[0], values[1], values[2]}, is_none}; }
};

/// The frames in which the boxes of groups are given, each with a displacement in the step.
class GroupFrames {
 public:
  static constexpr Index mixed = -1;  ///< the group of a node with primitives of several groups

  GroupFrames() = default;
  /// @param motions displacement of the frame of each group
  /// @param reach bound of these and of all numbers of boxes, for rounding
  GroupFrames(std::span<const Vector3> motions, double reach);

  /// Do all groups have the same frame?
  bool are_alike() const { return ranges_.empty(); }

  /// How much boxes of group `a` grow in the frame of group `b`: by all displacements from none to that of the one
  /// frame relative to the other.
  BoxGrowth growth(Index a, Index b) const;

 private:
  const std::array<float, 6>& range(Index group) const { return group == mixed ? ranges_.back() : ranges_[group]; }

  std::vector<std::array<float, 6>> ranges_;  // of the displacement of each group, as a PackedBox; of all groups last
  float rounding_ = 0;
};

inline BoxGrowth GroupFrames::growth(Index a, Index b) const {
  BoxGrowth growth;
  if (a == b && a != mixed) return growth;
  const std::array<float, 6>&first = range(a), &second = range(b);
  for (std::size_t k = 0; k < 6; ++k) {
    const float sum = first[k] + second[(k + 3) % 6];
    if (sum < 0) growth.values[k] = std::max(sum - rounding_, std::numeric_limits<float>::lowest());
    growth.is_none = growth.is_none && !(sum < 0);
  }
  return growth;
}

inline PackedBox grown(const PackedBox& box, const BoxGrowth& growth) {
  PackedBox result = box;
  for (std::size_t k = 0; k < 6; ++k)
    result.values[k] = std::max(box.values[k] + growth.values[k], std::numeric_limits<float>::lowest());
  return result;
}

}  // namespace stiv
