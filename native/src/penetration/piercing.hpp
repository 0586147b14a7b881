// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "acceptance/intersection/exact_meeting.hpp"

namespace stiv {

/// A segment that goes through a triangle.
struct Piercing {
  int step = 0;                                     ///< 1 from the triangle's front to its back, else -1
  double at = 0;                                    ///< fraction of the segment
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< weights of the triangle's second and third corner
};

/// Whether it does, the segment nudged (see nudged_orientation.hpp). That and `step` are exact, the rest is rounded.
/// @param touching set to true where the nudge had a say
std::optional<Piercing> piercing(const Segment& segment, const Triangle& triangle, int nudge, bool& touching);

}  // namespace stiv
