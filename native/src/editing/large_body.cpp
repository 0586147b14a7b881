// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/large_body.hpp"

#include <algorithm>
#include <vector>

#include "stiv/detection/detector.hpp"

namespace stiv {

namespace {

/// A mark for each large body that may move.
std::vector<unsigned char> large_bodies(const Surface& surface) {
  std::vector<Index> counts(surface.bodies().size(), 0);
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (!surface.is_fixed(vertex)) ++counts[at(surface.body_of(vertex))];
  std::vector<unsigned char> large;
  for (const Index count : counts) large.push_back(count >= DetectorOptions().large_body);
  return large;
}

}  // namespace

double mean_edge_of_large_bodies(const Surface& surface, const Positions& q) {
  if (surface.bodies().size() < 2) return 0;
  const std::vector<unsigned char> large = large_bodies(surface);
  if (std::find(large.begin(), large.end(), 1) == large.end()) return 0;
  double sum = 0;
  Index count = 0;
  for (const auto& edge : surface.edges().rowwise()) {
    if (large[at(surface.body_of(edge[0]))] == 0) continue;
    sum += (q.row(edge[0]) - q.row(edge[1])).norm();
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace stiv
