// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "stiv/detection/bounds.hpp"
#include "stiv/execution.hpp"

namespace stiv {

/// Numbers of two primitives.
struct PrimitivePair {
  Index first = 0;
  Index second = 0;
};

/// Which groups of primitives can form a pair that matters. Symmetric; empty: all.
class GroupTable {
 public:
  GroupTable() = default;
  GroupTable(Index groups, std::vector<unsigned char> meets) : groups_(groups), meets_(std::move(meets)) {}

  bool empty() const { return meets_.empty(); }
  bool meet(Index a, Index b) const { return empty() || meets_[static_cast<std::size_t>(a * groups_ + b)] != 0; }

 private:
  Index groups_ = 0;
  std::vector<unsigned char> meets_;  // (groups, groups)
};

/// Pairs that a traversal found; grows, and is used again for the next block.
struct PairBuffer {
  std::vector<PrimitivePair> pairs;
  std::size_t count = 0;
};

/// A bounding-volume hierarchy over boxes, built once and refitted when they move.
///
/// Eight boxes form a node, kept as arrays over the eight so that all of them are compared at once; leaves ("blocks")
/// hold eight primitives. The nodes of a level follow each other, so that the children of node i are the nodes 8i to
/// 8i + 7 of the level below, and no links are needed.
class Bvh {
 public:
  /// Builds over the centres of the given boxes. `groups[i]` (empty: all 0): primitives of different groups never share
  /// a block, and subtrees of groups that do not meet are not compared.
  explicit Bvh(const std::vector<Bounds>& boxes, const std::vector<Index>& groups = {});

  /// New boxes, same number and order. `active[i]` (empty: all) tells whether primitive i can be part of a pair that
  /// matters; two subtrees without any active primitive are never compared.
  void refit(const std::vector<Bounds>& boxes, const std::vector<unsigned char>& active = {});

  Index size() const { return size_; }

  /// Number of leaves, the units in which traversals are shared out.
  Index block_count() const { return static_cast<Index>(order_.size()) / width; }

  /// Appends the pairs (i of block `block` of this tree, j of `other`) whose boxes overlap and of which at least one
  /// is active, except those of groups that do not meet. If `other` is this very tree, each unordered pair comes from
  /// one of its two blocks only, and i != j. The order depends on the trees alone.
  void overlaps_of_block(Index block, const Bvh& other, const GroupTable& groups, PairBuffer& found) const;

  /// Pairs (i of a, j of b) whose boxes overlap and of which at least one is active. Order depends on the trees alone.
  /// Several threads work; `pairs` come out the same for any number of them.
  static std::vector<std::pair<Index, Index>> overlapping_pairs(const Bvh& a, const Bvh& b, const Execution& execution);
  /// The same within one tree, each unordered pair once, i != j.
  static std::vector<std::pair<Index, Index>> overlapping_pairs(const Bvh& tree, const Execution& execution);

  static constexpr Index width = 8;

 private:
  /// Boxes, activity and groups of eight children. Absent children have boxes of NaN, which overlap nothing.
  struct Node {
    float low[3][width];
    float high[3][width];
    std::int32_t active[width];
    Index group[width];  ///< of all primitives below, or Bvh::mixed

    static Node vacant();
    bool present(Index child) const { return low[0][child] == low[0][child]; }
    void set_box(Index child, const Bounds& box);
    Bounds box(Index child) const;
    Bounds bounds() const;
    /// Makes `child` of this node the summary of a node one level below.
    void summarise(Index child, const Node& below);
  };
  class Traversal;

  static constexpr Index mixed = -1;

  void reserve_levels(const std::vector<Index>& groups);

  Index size_ = 0;
  std::vector<Index> order_;               // primitive of each place in the blocks, -1: none
  std::vector<std::vector<Node>> levels_;  // blocks first, the root last
};

}  // namespace stiv
