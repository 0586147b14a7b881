// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/piercing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "penetration/nudged_orientation.hpp"

namespace stiv {

namespace {

/// Fraction of the segment at which it meets the plane of the triangle.
double fraction_at(const Segment& segment, const Triangle& t) {
  const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double from = std::abs(normal.dot(segment[0] - t[0])), to = std::abs(normal.dot(segment[1] - t[0]));
  return from + to > 0 ? from / (from + to) : 0.5;
}

/// Weights from the volumes over the segment and each side. They have one sign; what rounding turns counts as none.
Eigen::Vector2d place_in(const Triangle& t, const Segment& segment, int sign) {
  const Vector3 along = segment[1] - segment[0];
  const auto volume_over = [&](std::size_t k) {
    const Vector3 from = t[k] - segment[0], to = t[(k + 1) % 3] - segment[0];
    return std::max(-sign * along.dot(from.cross(to)), 0.0);
  };
  const double third = volume_over(0), first = volume_over(1), second = volume_over(2), sum = first + second + third;
  return sum > 0 ? Eigen::Vector2d(second / sum, third / sum) : Eigen::Vector2d::Constant(1.0 / 3);
}

}  // namespace

std::optional<Piercing> piercing(const Segment& segment, const Triangle& triangle, int nudge, bool& touching) {
  const NudgedSign from = nudged_side(triangle, segment[0], nudge), to = nudged_side(triangle, segment[1], nudge);
  touching = touching || from.touching || to.touching;
  if (from.value * to.value >= 0) return std::nullopt;
  std::array<int, 3> turns{};
  for (std::size_t k = 0; k < 3; ++k) {
    const NudgedSign turn = nudged_turn(segment, {triangle[k], triangle[(k + 1) % 3]}, -nudge);
    touching = touching || turn.touching;
    turns[k] = turn.value;
  }
  const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
  if (*least < 0 && *most > 0) return std::nullopt;
  const int step = to.value;  // positive below the triangle
  return Piercing{step, fraction_at(segment, triangle), place_in(triangle, segment, *least < 0 ? -1 : 1)};
}

}  // namespace stiv
