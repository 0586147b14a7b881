// SPDX-License-Identifier: GPL-3.0-or-later
// Consecutive states of a small mesh: trees, stars and filters find the intersections of the exact test of each pair,
// for any order of triangles and corners.
#include <algorithm>

#include "small_mesh.hpp"
#include "stiv/acceptance/intersections.hpp"

using namespace stiv;
using fuzz::Corners;
using fuzz::corners;

namespace {

bool meet(const Corners& a, const Corners& b, const Positions& q) {
  const bool answer = triangles_intersect(a, b, q);
  fuzz::require(triangles_intersect(b, a, q) == answer, "the order of triangles means nothing");
  fuzz::require(triangles_intersect({a[1], a[2], a[0]}, {b[1], b[0], b[2]}, q) == answer,
                "the order of corners means nothing");
  return answer;
}

IndexPairs all_pairs(const Surface& surface, const Positions& q) {
  IndexPairs pairs;
  for (Index a = 0; a < surface.triangles().rows(); ++a)
    for (Index b = a + 1; b < surface.triangles().rows(); ++b)
      if (meet(corners(surface, a), corners(surface, b), q)) pairs.emplace_back(a, b);
  return pairs;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const FloatingPointScope floating_point;
  const auto surface = fuzz::small_surface(input);
  const bool on_grid = input.below(4) != 0;
  IntersectionTest test(surface);
  Execution execution(1);
  Positions q = input.positions(surface->vertex_count(), on_grid);
  for (int round = 0; round < 4; ++round) {
    const IndexPairs expected = all_pairs(*surface, q);
    fuzz::require(test.find(q, execution) == expected, "the whole test equals the test of all pairs");
    const StaticPairs found = test.find_all(q, execution);
    fuzz::require(found.faces == expected, "and so do the faces beside loose edges and vertices");
    const bool free = found.empty();
    fuzz::require(test.is_free(q, {}, execution) == free, "free means that nothing is found");
    if (input.empty()) break;
    std::vector<unsigned char> moved(static_cast<std::size_t>(q.rows()), 0);
    for (Index vertex = 0; vertex < q.rows(); ++vertex) {
      if (input.below(4) != 0) continue;
      q.row(vertex) = input.point(on_grid);
      moved[static_cast<std::size_t>(vertex)] = 1;
    }
    if (free)
      fuzz::require(test.is_free(q, moved, execution) == test.is_free(q, {}, execution),
                    "from a free state, only pairs with a moved vertex count");
  }
  return 0;
}
