// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/touching_pairs.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "acceptance/clearance/triangle_distance.hpp"

namespace stiv {

namespace {

using Corners = std::array<Index, 3>;

Corners corners_of(const Surface& surface, Index triangle) {
  const Triangles& triangles = surface.triangles();
  return {triangles(triangle, 0), triangles(triangle, 1), triangles(triangle, 2)};
}

bool has(const Corners& triangle, Index corner) {
  return std::find(triangle.begin(), triangle.end(), corner) != triangle.end();
}

/// The triangle with its corners that another one has at its end. Returns how many these are.
std::ptrdiff_t put_shared_last(Corners& triangle, const Corners& other) {
  const auto shared =
      std::partition(triangle.begin(), triangle.end(), [&](Index corner) { return !has(other, corner); });
  return triangle.end() - shared;
}

/// The distance of two triangles that do not intersect; of triangles with common corners, that of the sides and corners
/// that are not common.
double distance_apart(Corners a, Corners b, const PositionsView& q) {
  const auto distance = [&](const Corners& first, const Corners& second) {
    return triangle_distance(first, second, q).distance;
  };
  const std::ptrdiff_t shared = put_shared_last(a, b);
  put_shared_last(b, a);
  if (shared == 0) return distance(a, b);
  if (shared == 1) return std::min(distance({a[0], a[1], a[1]}, b), distance(a, {b[0], b[1], b[1]}));
  const double to_corners = std::min(distance({a[0], a[0], a[0]}, b), distance(a, {b[0], b[0], b[0]}));
  const Index v = a[1], w = a[2];  // sides that meet in no corner
  return std::min({to_corners, distance({v, a[0], a[0]}, {w, b[0], b[0]}), distance({w, a[0], a[0]}, {v, b[0], b[0]})});
}

}  // namespace

IndexPairs find_touching(const std::shared_ptr<const Surface>& surface, const IndexPairs& bodies,
                         const PositionsView& q, double distance, Execution& execution) {
  IndexPairs near = IntersectionTest(surface, {.lists_near_pairs = true}).find_near(q, distance, execution);
  std::vector<unsigned char> touch(near.size(), 0);
  execution.for_chunks(static_cast<Index>(near.size()), 256, [&](Index begin, Index end, Index) {
    for (Index k = begin; k < end; ++k) {
      const Corners a = corners_of(*surface, near[at(k)].first), b = corners_of(*surface, near[at(k)].second);
      const std::pair<Index, Index> pair = std::minmax(surface->body_of(a[0]), surface->body_of(b[0]));
      touch[at(k)] = std::binary_search(bodies.begin(), bodies.end(), pair) && distance_apart(a, b, q) < distance &&
                     !triangles_intersect(a, b, q);
    }
  });
  IndexPairs found;
  for (std::size_t k = 0; k < near.size(); ++k)
    if (touch[k] != 0) found.push_back(near[k]);
  return found;
}

}  // namespace stiv
