// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "detection/broad_phase/block_incidence.hpp"
#include "detection/broad_phase/block_order.hpp"
#include "detection/broad_phase/bounds.hpp"
#include "detection/broad_phase/group_frames.hpp"
#include "detection/broad_phase/numbered_point.hpp"
#include "detection/primitive_pair.hpp"
#include "stiv/execution.hpp"

namespace stiv {

/// Which groups of primitives can form relevant pairs. Symmetric; empty: all.
class GroupTable {
 public:
  GroupTable() = default;
  GroupTable(Index groups, std::vector<unsigned char> meets) : groups_(groups), meets_(std::move(meets)) {}

  bool empty() const { return meets_.empty(); }
  bool meet(Index a, Index b) const { return empty() || meets_[static_cast<std::size_t>(a) * groups_ + b] != 0; }

 private:
  Index groups_ = 0;
  std::vector<unsigned char> meets_;  // (groups, groups)
};

/// Knowledge of a traversal about groups of primitives.
struct GroupRelations {
  GroupTable table{};
  GroupFrames frames{};
};

/// Pairs that a traversal found, one array for each side. Its memory is reused.
struct PairBuffer {
  std::vector<Index> first, second;
  /// Of each pair, the four corners of a vertex and a face, or of two edges (the lower one first): traversals have them
  /// at hand. Not filled by other traversals. There is room for a node's width of pairs behind the last one.
  std::array<std::vector<Index>, 4> corners;
  std::size_t count = 0;

  /// Above this number of pairs, `full(*this)` is called from time to time. It may remove pairs or raise the limit, and
  /// returns whether to continue.
  std::size_t limit = std::numeric_limits<std::size_t>::max();
  std::function<bool(PairBuffer&)> full;

  PrimitivePair operator[](std::size_t k) const { return {first[k], second[k]}; }
};

/// Primitives as rows of vertices, so that a traversal can skip pairs that share one.
struct CornerRows {
  const Index* rows = nullptr;  ///< (n, size)
  Index size = 0;               ///< 1, 2 or 3; 0: none are given
};

/// A bounding-volume hierarchy over boxes, built once and refitted when they move.
///
/// Eight boxes form a node, kept as arrays over the eight so that all of them are compared at once; leaves ("blocks")
/// hold eight primitives. The nodes of a level follow each other, so that the children of node i are the nodes 8i to
/// 8i + 7 of the level below, and no links are needed.
class Bvh {
 public:
  static constexpr Index width = 8;

  /// Builds over the centers of the given boxes. `groups[i]` (empty: all 0): primitives of different groups never share
  /// a block, and subtrees of groups that do not meet are not compared.
  explicit Bvh(const std::vector<Bounds>& boxes, std::span<const Index> groups = {}, const CornerRows& corners = {});
  /// Builds over the centers of primitives; the boxes come with the first refit.
  Bvh(NumberedPoints centres, const PrimitiveGroups& groups, const CornerRows& corners, const Execution& execution);
  /// The same in a given order of all `count` primitives, as block_order returns it.
  Bvh(LargeArray<Index> order, Index count, std::span<const Index> groups, const CornerRows& corners,
      const Execution& execution);

  Index size() const { return size_; }

  /// New boxes, same number and order. `active[i]` (empty: all) tells whether primitive i can form a relevant
  /// pair; two subtrees without any active primitive are never compared.
  void refit(const std::vector<Bounds>& boxes, const std::vector<unsigned char>& active = {});

  /// The same with `box_of(primitive)`, a PackedBox, on several threads.
  template <class BoxOf>
  void refit(const BoxOf& box_of, const Execution& execution);

  /// The same where a primitive's box is the union of those of its corners (at least one).
  void refit_corners(std::span<const PackedBox> vertices, const Execution& execution);
  /// For the primitives of groups that are marked in `changed`.
  void refit_groups_corners(const std::vector<unsigned char>& changed, std::span<const PackedBox> vertices,
                            const Execution& execution);
  /// The same for the primitives with a corner among `changed`. The cost does not depend on the others.
  void refit_some_corners(std::span<const Index> changed, std::span<const PackedBox> vertices);
  /// Allocates what the first refit of some corners would allocate, if only the first vertices ever change.
  void prepare_refit_some_corners(Index vertex_count);
  /// For a tree whose corners are names: the vertices of each block, (blocks, size, width), -1: none.
  LargeArray<Index> block_corners(const CornerRows& rows) const;
  void refit_groups_corners(const std::vector<unsigned char>& changed, std::span<const Index> block_corners,
                            std::span<const PackedBox> vertices, const Execution& execution);

  /// Other corners for the same primitives; in groups that are not marked in `changed`, they must be the same ones, or
  /// none if there were none before.
  void set_corners(const CornerRows& corners, const std::vector<unsigned char>& changed, const Execution& execution);

  /// Two subtrees to compare: a unit of work.
  struct Task {
    Index level, node;              ///< of this tree
    Index other_level, other_node;  ///< of the other tree
  };

  /// About this many tasks, always the same ones for the same trees. Together they cover all pairs (i of this tree, j
  /// of `other`) with overlapping boxes of which one is active. Pairs of groups that are not tested are skipped; if
  /// both trees know their corners, so are pairs that share one. Boxes are given in the frames of their groups. Within
  /// one tree, each unordered pair is reported once, with i != j.
  std::vector<Task> tasks(const Bvh& other, const GroupRelations& groups, std::size_t about = 256) const;

  /// Appends the pairs of one task, in an order that depends on the trees alone.
  void overlaps(const Task& task, const Bvh& other, const GroupRelations& groups, PairBuffer& found) const;

  /// All pairs at once; the same for any number of threads.
  static std::vector<std::pair<Index, Index>> overlapping_pairs(const Bvh& a, const Bvh& b, const Execution& execution);
  static std::vector<std::pair<Index, Index>> overlapping_pairs(const Bvh& tree, const Execution& execution);

  /// A node as traversals read it.
  struct Node {
    alignas(32) float planes[8][width];  ///< PackedBox::values of eight children, absent ones empty
  };
  struct Level {
    LargeArray<Node> nodes;
    LargeArray<PackedBox> boxes;  ///< of each node
    LargeArray<Index> groups;     ///< of all primitives below each node, or Bvh::mixed
  };
  const std::vector<Level>& levels() const { return levels_; }
  const LargeArray<Index>& order() const { return order_; }
  const LargeArray<Index>& corners() const { return corners_; }  ///< (blocks, corner_size, width)
  Index corner_size() const { return corner_size_; }

  static constexpr Index mixed = GroupFrames::mixed;

 private:
  void set_child(Level& level, std::size_t child, const PackedBox& box);
  void finish_node(Level& level, std::size_t node);
  /// The nodes number `begin` to `end` of a list, or of all (nullptr), from the boxes of the level below.
  void summarise(std::size_t level, const Index* nodes, Index begin, Index end);
  void begin(std::span<const Index> groups, const CornerRows& corners, const Execution& execution);
  void reserve_levels(std::span<const Index> groups);

  void list_corners(const CornerRows& rows, Index block, LargeArray<Index>& corners) const;
  template <class BoxOf>
  void refit_block(std::size_t block, const BoxOf& box_of);
  /// Blocks number `begin` to `end` of a list, or of all (nullptr).
  void refit_blocks(const Index* blocks, Index begin, Index end, std::span<const Index> corners,
                    const PackedBox* vertices);
  void find_touched(std::span<const Index> vertices);
  void summarise_touched();
  void list_parents(const std::vector<Index>& nodes, std::vector<Index>& parents) const;
  void list_nodes_of(const std::vector<unsigned char>& groups);
  void summarise_all(const Execution& execution);

  static constexpr Index chunk_size = 512;

  Index size_ = 0;
  LargeArray<Index> order_;    // primitive of each place in the blocks, -1: none
  std::vector<Level> levels_;  // blocks first, the root last
  LargeArray<Index> corners_;
  Index corner_size_ = 0;
  std::optional<BlockIncidence> incidence_;      // of these corners, for refit_some_corners
  std::vector<unsigned char> is_touched_;        // its work space: for each block, zero between calls
  std::vector<Index> touched_, parents_;         // the blocks, ascending
  std::vector<unsigned char> listed_groups_;     // mostly the same bodies move in all steps
  std::vector<std::vector<Index>> group_nodes_;  // of each level: the nodes above primitives of these, ascending
};

/// The center of a box, zero where it is infinite.
NumberedPoint centre_of(const Bounds& box, Index number);
/// The same for each of several boxes.
NumberedPoints centres_of(const std::vector<Bounds>& boxes);

template <class BoxOf>
void Bvh::refit_block(std::size_t block, const BoxOf& box_of) {
  Level& blocks = levels_[0];
  PackedBox all = PackedBox::empty();
  for (std::size_t lane = 0; lane < width; ++lane) {
    const Index primitive = order_[block * width + lane];
    const PackedBox box = primitive >= 0 ? box_of(primitive) : PackedBox::empty();
    for (std::size_t k = 0; k < 8; ++k) blocks.nodes[block].planes[k][lane] = box.values[k];
    all.include(box);
  }
  blocks.boxes[block] = all;
}

template <class BoxOf>
void Bvh::refit(const BoxOf& box_of, const Execution& execution) {
  if (levels_.empty()) return;
  execution.for_chunks(static_cast<Index>(levels_[0].nodes.size()), chunk_size, [&](Index begin, Index end, Index) {
    for (Index block = begin; block < end; ++block) refit_block(static_cast<std::size_t>(block), box_of);
  });
  summarise_all(execution);
}

}  // namespace stiv
