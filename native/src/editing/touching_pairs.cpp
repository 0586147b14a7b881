// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/touching_pairs.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "acceptance/clearance/triangle_distance.hpp"
#include "acceptance/intersection/near_pairs.hpp"

namespace stiv {

namespace {

using Corners = std::array<Index, 3>;

Corners corners_of(const Surface& surface, Index triangle) {
  const Triangles& triangles = surface.triangles();
  return {triangles(triangle, 0), triangles(triangle, 1), triangles(triangle, 2)};
}

/// Keeps those of pairs of triangles for which a test is true.
template <typename Test>
IndexPairs chosen(const IndexPairs& pairs, const Test& test, Execution& execution) {
  std::vector<unsigned char> passes(pairs.size(), 0);
  execution.for_chunks(static_cast<Index>(pairs.size()), 256, [&](Index begin, Index end, Index) {
    for (Index k = begin; k < end; ++k) passes[at(k)] = test(pairs[at(k)]);
  });
  IndexPairs found;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (passes[k] != 0) found.push_back(pairs[k]);
  return found;
}

}  // namespace

IndexPairs find_touching(const std::shared_ptr<const Surface>& surface, const IndexPairs& bodies,
                         const PositionsView& q, double distance, Execution& execution) {
  const IndexPairs contacts = find_contacts(surface, bodies, q, distance, execution);
  const auto is_apart = [&](const std::pair<Index, Index>& pair) {
    return !triangles_intersect(corners_of(*surface, pair.first), corners_of(*surface, pair.second), q);
  };
  return chosen(contacts, is_apart, execution);
}

IndexPairs find_contacts(const std::shared_ptr<const Surface>& surface, const IndexPairs& bodies,
                         const PositionsView& q, double distance, Execution& execution) {
  if (bodies.empty()) return {};
  const IndexPairs near = IntersectionTest(surface, {.lists_near_pairs = true}).find_near(q, distance, execution);
  const auto are_in_contact = [&](const std::pair<Index, Index>& pair) {
    const Corners a = corners_of(*surface, pair.first), b = corners_of(*surface, pair.second);
    const std::pair<Index, Index> both = std::minmax(surface->body_of(a[0]), surface->body_of(b[0]));
    return std::binary_search(bodies.begin(), bodies.end(), both) &&
           (distance_apart(a, b, q) < distance || triangles_intersect(a, b, q));
  };
  return chosen(near, are_in_contact, execution);
}

IndexPairs bodies_within_reach(const Surface& surface, const std::vector<Index>& bodies, const PositionsView& q,
                               double distance) {
  if (bodies.size() < 2) return {};
  std::vector<Eigen::AlignedBox3d> boxes(surface.bodies().size());
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    boxes[at(surface.body_of(vertex))].extend(Vector3(q.row(vertex)));
  std::vector<Index> sorted = bodies;  // by their first x, so that each is only compared with those that begin in it
  std::sort(sorted.begin(), sorted.end(),
            [&](Index a, Index b) { return boxes[at(a)].min().x() < boxes[at(b)].min().x(); });
  IndexPairs near;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const Eigen::AlignedBox3d& box = boxes[at(sorted[i])];
    for (std::size_t k = i + 1; k < sorted.size(); ++k) {
      const Eigen::AlignedBox3d& other = boxes[at(sorted[k])];
      if (other.min().x() - box.max().x() > distance) break;
      if (box.exteriorDistance(other) <= distance && surface.bodies_meet(sorted[i], sorted[k]))
        near.push_back(std::minmax(sorted[i], sorted[k]));
    }
  }
  sort_unique(near);
  std::erase_if(near, [](const auto& pair) { return pair.first == pair.second; });
  return near;
}

}  // namespace stiv
