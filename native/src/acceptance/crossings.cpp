// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/crossings.hpp"

#include <algorithm>
#include <cmath>

#include "acceptance/exact_meeting.hpp"
#include "stiv/acceptance/predicates.hpp"

namespace stiv {

namespace {

enum class Meeting { none, strict, degenerate };

/// Does the edge meet the triangle, and if so inside of both? `step` of the piercing is set.
Meeting meeting_of(const Segment& edge, const Triangle& t, int& step) {
  const int from = orientation_3d(t[0], t[1], t[2], edge[0]), to = orientation_3d(t[0], t[1], t[2], edge[1]);
  if (from * to > 0) return Meeting::none;
  const int a = orientation_3d(edge[0], edge[1], t[0], t[1]), b = orientation_3d(edge[0], edge[1], t[1], t[2]),
            c = orientation_3d(edge[0], edge[1], t[2], t[0]);
  if (from * to < 0) {
    step = to;  // positive below the triangle
    if (std::min({a, b, c}) < 0 && std::max({a, b, c}) > 0) return Meeting::none;
    return a * b * c != 0 ? Meeting::strict : Meeting::degenerate;
  }
  return segment_meets_triangle(edge, t) ? Meeting::degenerate : Meeting::none;
}

/// Fraction of the edge at which it meets the plane of the triangle.
double fraction_at(const Segment& edge, const Triangle& t) {
  const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double from = std::abs(normal.dot(edge[0] - t[0])), to = std::abs(normal.dot(edge[1] - t[0]));
  return from + to > 0 ? from / (from + to) : 0.5;
}

}  // namespace

std::optional<Cut> crossing(const Surface& surface, const Positions& q, const std::array<Index, 2>& triangles,
                            std::vector<Piercing>& piercings) {
  const auto corner = [&](int side, Index k) {
    return surface.triangles()(triangles[static_cast<std::size_t>(side)], k);
  };
  const auto at = [&](Index vertex) -> Vector3 { return q.row(vertex); };
  Cut cut{triangles, {}};
  std::size_t found = 0;
  for (int side = 0; side < 2; ++side) {
    const Triangle other{at(corner(1 - side, 0)), at(corner(1 - side, 1)), at(corner(1 - side, 2))};
    for (Index k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({corner(side, k), corner(side, (k + 1) % 3)});
      const Segment edge{at(low), at(high)};  // in one order, so that both triangles of an edge find the same
      int step = 0;
      const Meeting meeting = meeting_of(edge, other, step);
      if (meeting == Meeting::none) continue;
      if (meeting == Meeting::degenerate || found == 2) return std::nullopt;
      const double fraction = fraction_at(edge, other);
      piercings.push_back({{low, high}, triangles[static_cast<std::size_t>(1 - side)], step, fraction});
      cut.ends[found++] = edge[0] + fraction * (edge[1] - edge[0]);
    }
  }
  if (found < 2) return std::nullopt;
  return cut;
}

}  // namespace stiv
