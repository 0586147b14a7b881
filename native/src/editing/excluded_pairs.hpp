// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Pairs of triangles that may intersect. An event belongs to all pairs of a triangle at its first side and one at its
/// second; it is passed over only if each of them is excluded, so that all other pairs stay guarded: where a vertex
/// pierces a face, it may go back through only if no triangle around it would be left behind, intersecting anew.
class ExcludedPairs {
 public:
  /// @throws InputError: a triangle that there is not, or a pair of one with itself
  ExcludedPairs(std::shared_ptr<const Surface> surface, const IndexPairs& pairs);

  bool empty() const { return pairs_.empty(); }

  /// Without the events that belong to excluded pairs alone.
  void remove_from(Events& events) const;

  /// Intersecting pairs, sorted and smaller index first, that are not excluded.
  IndexPairs others(const IndexPairs& pairs) const;

 private:
  bool contains(Index a, Index b) const;
  bool covers(const Event& event) const;
  std::vector<Index> triangles_with(const Index* begin, const Index* end) const;

  std::shared_ptr<const Surface> surface_;
  IndexPairs pairs_;
  std::vector<std::vector<Index>> around_;  // triangles of each vertex; empty without pairs
};

}  // namespace stiv
