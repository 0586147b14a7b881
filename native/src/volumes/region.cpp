// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/volumes/region.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace stiv {

namespace {

/// A normal tells a way out only if the two sides approach each other along it. Below this cosine the sides slide, and
/// the sign of n . Drho is rounding. [DESIGN 4, "Traps"]
constexpr double least_cosine = 1e-8;

bool normal_is_usable(const Event& event, const Positions& displacement) {
  const Vector3 relative = weighted_sum(event, displacement);
  return event.normal.dot(relative) < -least_cosine * relative.norm();
}

/// The vertex among corners [begin, end) in whose barycentric cell the contact lies; the first of equals.
Index heaviest_vertex(const Event& event, int begin, int end) {
  int heaviest = begin;
  for (int k = begin + 1; k < end; ++k)
    if (std::abs(event.weights[k]) > std::abs(event.weights[heaviest])) heaviest = k;
  return event.vertices[heaviest];
}

}  // namespace

std::vector<Region> earliest_regions(const Events& events, const Positions& displacement) {
  std::vector<Region> regions;
  for (Index k = 0; k < static_cast<Index>(events.size()); ++k) {
    const Event& event = events[k];
    if (!normal_is_usable(event, displacement)) continue;
    const int split = first_side_size(event.kind);
    regions.push_back({heaviest_vertex(event, 0, split), k});
    regions.push_back({heaviest_vertex(event, split, 4), k});
  }
  std::sort(regions.begin(), regions.end(), [&](const Region& a, const Region& b) {
    return std::tie(a.vertex, events[a.event].time, a.event) < std::tie(b.vertex, events[b.event].time, b.event);
  });
  const auto same_vertex = [](const Region& a, const Region& b) { return a.vertex == b.vertex; };
  regions.erase(std::unique(regions.begin(), regions.end(), same_vertex), regions.end());
  return regions;
}

}  // namespace stiv
