// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Pairs of triangles that may intersect: the given ones, and pairs next to them that touch. An event belongs to every
/// pair of a triangle at its first side and one at its second. It is ignored only if each of these pairs is excluded,
/// so that all other pairs stay guarded. (mathematics.md, "Excluded pairs")
class ExcludedPairs {
 public:
  /// Two triangles touch if they are apart at the start, but nearer than `least`, the least separation that survives
  /// storing. Where a curve of intersection passes an edge so closely, it cannot be kept on its side of the edge. Only
  /// neighbors of the triangles of a given pair are added, and never a pair that intersects at the start.
  /// @param start of the surface's vertices that are not those of obstacles
  /// @throws InputError: a triangle out of range, or a triangle with itself
  ExcludedPairs(std::shared_ptr<const Surface> surface, const IndexPairs& pairs, const PositionsView& start,
                double least);

  bool empty() const { return pairs_.empty(); }
  const IndexPairs& pairs() const { return pairs_; }  ///< sorted, with the smaller index first

  /// Removes the events that belong only to excluded pairs.
  void remove_from(Events& events) const;

  /// The pairs, sorted and with the smaller index first, that are not excluded.
  IndexPairs others(const IndexPairs& pairs) const;

  /// Whether more pairs intersect than before. Those that touched before are not counted: rounding decides whether they
  /// intersect.
  /// @param before the pairs that intersected at `from`, sorted like `now`
  /// @param from of all vertices
  bool are_more(const IndexPairs& now, const IndexPairs& before, const PositionsView& from) const;

 private:
  void add_touching(const PositionsView& start);
  std::vector<Index> with_neighbors(Index triangle) const;
  bool contains(Index a, Index b) const;
  bool covers(const Event& event) const;
  std::vector<Index> triangles_with(const Index* begin, const Index* end) const;

  std::shared_ptr<const Surface> surface_;
  double least_;
  IndexPairs pairs_;
  std::vector<std::vector<Index>> around_;  // triangles of each vertex; empty without pairs
};

}  // namespace stiv
