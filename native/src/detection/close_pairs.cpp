// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/close_pairs.hpp"

#include <algorithm>

#include "detection/hull_filter.hpp"
#include "detection/relevance.hpp"

namespace stiv {

namespace {

/// Does no plane across an axis keep the sides so far apart for the whole step that their boxes might be? Broad phases
/// leave out some of the others, and which ones depends on where boxes were seen from: what is left does not.
bool near_along_axes(const VertexStep* steps, EventKind kind, const std::array<Index, 4>& v, double separation) {
  const std::size_t others = kind == EventKind::vertex_face ? 1 : 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double least_gap = never, least_gap_behind = never;
    for (std::size_t i = 0; i < others; ++i)
      for (std::size_t j = others; j < 4; ++j) {
        const VertexStep &a = steps[v[i]], &b = steps[v[j]];
        const double start = a.start[axis] - b.start[axis], end = a.end[axis] - b.end[axis];
        least_gap = std::min({least_gap, start, end});
        least_gap_behind = std::min({least_gap_behind, -start, -end});
      }
    if (std::max(least_gap, least_gap_behind) > 1.1 * separation) return false;
  }
  return true;
}

}  // namespace

void append_close(const Surface& surface, EventKind kind, std::span<const Candidate> candidates,
                  const VertexSteps& vertices, const Vector3& motion, double separation,
                  std::vector<Candidate>& close) {
  PairBlock block;
  PairFlags apart;
  std::array<Candidate, PairBlock::capacity> some;
  // With less room for rounding than a source has, so that none can have left out what is close.
  const NearbySteps same_step{motion, separation, 0, 0x1p-44};
  const auto append_some = [&] {
    find_hulls_apart(kind, block, vertices, same_step, apart);
    for (std::size_t k = 0; k < block.count; ++k)
      if (apart[k] == 0) close.push_back(some[k]);
    block.count = 0;
  };
  for (const Candidate& candidate : candidates) {
    const std::array<Index, 4> v = vertices_of(surface, kind, candidate);
    if (!near_along_axes(vertices.data(), kind, v, separation)) continue;
    some[block.count] = candidate;
    block.add(v);
    if (block.count == PairBlock::capacity) append_some();
  }
  append_some();
}

}  // namespace stiv
