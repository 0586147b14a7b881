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
