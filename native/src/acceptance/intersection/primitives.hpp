// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "detection/broad_phase/bvh.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Corner indices of triangles. Edges and vertices are triangles without area: (a, b, b), (a, a, a).
using CornerList = LargeArray<std::array<Index, 3>>;

CornerList triangle_corners(const Surface& surface);
CornerList loose_edge_corners(const Surface& surface);
/// Vertices of no triangle and no loose edge.
CornerList loose_vertex_corners(const Surface& surface);

/// Primitives of one kind and their tree, which the first update builds and later updates refit. Bodies without any
/// change since the last update are left as they are.
class Primitives {
 public:
  Primitives(const Surface& surface, CornerList corners);

  /// Notes that vertices of the marked bodies changed.
  void note_changes(const std::vector<unsigned char>& bodies);

  /// A primitive is active if one of its vertices is.
  void update(std::span<const PackedBox> vertices, const Execution& execution);

  /// Excludes pairs that share a vertex marked in `free_stars`, (N), from later searches of the tree with itself.
  /// @param changed bodies in which vertices may be marked otherwise than in the last call
  void leave_out_neighbours(const std::vector<unsigned char>& free_stars, const std::vector<unsigned char>& changed,
                            const Execution& execution);

  bool empty() const { return corners_.empty(); }
  const std::array<Index, 3>& corners(Index k) const { return corners_[at(k)]; }
  const CornerList& all_corners() const { return corners_; }
  const Bvh& tree() const { return *tree_; }

 private:
  CornerList corners_;
  LargeArray<Index> bodies_;
  std::vector<unsigned char> at_rest_;  // fixed bodies
  std::vector<unsigned char> changed_;  // bodies, since the last update
  LargeArray<Index> names_;             // of corners in the tree, three for each primitive
  LargeArray<Index> block_corners_;     // vertices in the tree's order
  std::optional<Bvh> tree_;
};

}  // namespace stiv
