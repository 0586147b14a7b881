// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/bvh.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "detection/block_order.hpp"

namespace stiv {

namespace {

std::size_t at(Index index) { return static_cast<std::size_t>(index); }

}  // namespace

Bvh::Node Bvh::Node::vacant() {
  Node node{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::fill_n(node.low[axis], width, std::numeric_limits<float>::quiet_NaN());
    std::fill_n(node.high[axis], width, std::numeric_limits<float>::quiet_NaN());
  }
  return node;
}

void Bvh::Node::set_box(Index child, const Bounds& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis][child] = box.low[axis];
    high[axis][child] = box.high[axis];
  }
}

Bounds Bvh::Node::box(Index child) const {
  return {{low[0][child], low[1][child], low[2][child]}, {high[0][child], high[1][child], high[2][child]}};
}

// std::min and std::max keep their first argument where the second is NaN.
Bounds Bvh::Node::bounds() const {
  Bounds all = Bounds::empty();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (Index child = 0; child < width; ++child) {
      all.low[axis] = std::min(all.low[axis], low[axis][child]);
      all.high[axis] = std::max(all.high[axis], high[axis][child]);
    }
  return all;
}

void Bvh::Node::summarise(Index child, const Node& below) {
  set_box(child, below.bounds());
  active[child] = *std::max_element(below.active, below.active + width);
  group[child] = below.group[0];
  for (Index k = 1; k < width; ++k)
    if (below.present(k) && below.group[k] != below.group[0]) group[child] = mixed;
}

Bvh::Bvh(const std::vector<Bounds>& boxes, const std::vector<Index>& groups)
    : size_(static_cast<Index>(boxes.size())), order_(block_order(boxes, groups, width)) {
  reserve_levels(groups);
  refit(boxes);
}

void Bvh::reserve_levels(const std::vector<Index>& groups) {
  for (Index count = block_count(); count > 0; count = (count + width - 1) / width) {
    levels_.emplace_back(at(count), Node::vacant());
    if (count == 1) break;
  }
  if (groups.empty()) return;
  for (std::size_t place = 0; place < order_.size(); ++place)
    if (order_[place] >= 0) levels_[0][place / at(width)].group[place % at(width)] = groups[at(order_[place])];
}

void Bvh::refit(const std::vector<Bounds>& boxes, const std::vector<unsigned char>& active) {
  for (std::size_t place = 0; place < order_.size(); ++place) {
    if (order_[place] < 0) continue;
    const std::size_t primitive = at(order_[place]);
    Node& block = levels_[0][place / at(width)];
    block.set_box(static_cast<Index>(place) % width, boxes[primitive]);
    block.active[place % at(width)] = active.empty() || active[primitive] != 0;
  }
  for (std::size_t level = 1; level < levels_.size(); ++level)
    for (std::size_t child = 0; child < levels_[level - 1].size(); ++child)
      levels_[level][child / at(width)].summarise(static_cast<Index>(child) % width, levels_[level - 1][child]);
}

/// The descent of one block of eight queries through a tree.
class Bvh::Traversal {
 public:
  Traversal(const Bvh& queries, Index block, const Bvh& tree, const GroupTable& groups, PairBuffer& found)
      : queries_(queries.levels_[0][at(block)]),
        primitives_(queries.order_.data() + block * width),
        block_(&queries == &tree ? block : -1),
        tree_(tree),
        groups_(groups),
        found_(found),
        bounds_(queries_.bounds()),
        active_(*std::max_element(queries_.active, queries_.active + width)) {}

  void run() {
    // A node leaves seven siblings behind at most on each of the at most eleven levels that 2^31 primitives need.
    std::array<Entry, 96> stack;
    std::size_t top = 0;
    stack[top++] = {static_cast<Index>(tree_.levels_.size()) - 1, 0};
    while (top > 0) {
      const Entry entry = stack[--top];
      if (entry.level == 0)
        meet_block(entry.node);
      else
        descend(entry, stack.data(), top);
    }
  }

 private:
  struct Entry {
    Index level, node;
  };
  using Lanes = std::array<std::int32_t, width>;

  /// 1 for each child of `node` whose box overlaps; written so that the compiler compares several at once.
  static Lanes overlapping(const Node& node, const Bounds& box) {
    Lanes hit;
    for (Index k = 0; k < width; ++k)
      hit[at(k)] = static_cast<int>(node.low[0][k] <= box.high[0]) & static_cast<int>(node.high[0][k] >= box.low[0]) &
                   static_cast<int>(node.low[1][k] <= box.high[1]) & static_cast<int>(node.high[1][k] >= box.low[1]) &
                   static_cast<int>(node.low[2][k] <= box.high[2]) & static_cast<int>(node.high[2][k] >= box.low[2]);
    return hit;
  }

  static void keep_active(Lanes& hit, const Node& node, std::int32_t active) {
    for (Index k = 0; k < width; ++k) hit[at(k)] &= active | node.active[k];
  }

  /// Pushes the children to visit. Every child is written, and the stack grows by those that count: no branches.
  void descend(const Entry& entry, Entry* stack, std::size_t& top) const {
    const Node& node = tree_.levels_[at(entry.level)][at(entry.node)];
    Lanes hit = overlapping(node, bounds_);
    keep_active(hit, node, active_);
    if (!groups_.empty()) keep_meeting(hit, node);
    const Index level = entry.level - 1;
    for (Index k = 0; k < width; ++k) {
      const Index child = entry.node * width + k;
      const Index last_block = static_cast<Index>((static_cast<std::int64_t>(child) + 1) << (3 * level)) - 1;
      stack[top] = {level, child};
      top += static_cast<std::size_t>(hit[at(k)] & static_cast<int>(last_block >= block_));
    }
  }

  void keep_meeting(Lanes& hit, const Node& node) const {
    for (Index k = 0; k < width; ++k)
      if (hit[at(k)] != 0 && node.group[k] != mixed) hit[at(k)] = groups_.meet(queries_.group[0], node.group[k]);
  }

  void meet_block(Index block) {
    const Node& node = tree_.levels_[0][at(block)];
    if (!groups_.meet(queries_.group[0], node.group[0])) return;
    const Lanes near = overlapping(queries_, bounds_of_block(block));
    for (Index k = 0; k < width; ++k) {
      if (near[at(k)] == 0) continue;
      Lanes hit = overlapping(node, queries_.box(k));
      keep_active(hit, node, queries_.active[k]);
      if (block == block_)
        for (Index other = 0; other <= k; ++other) hit[at(other)] = 0;
      append(primitives_[k], tree_.order_.data() + block * width, hit);
    }
  }

  Bounds bounds_of_block(Index block) const {
    if (tree_.levels_.size() == 1) return tree_.levels_[0][0].bounds();
    return tree_.levels_[1][at(block / width)].box(block % width);
  }

  void append(Index primitive, const Index* others, const Lanes& hit) {
    if (found_.count + at(width) > found_.pairs.size()) found_.pairs.resize(2 * found_.pairs.size() + 1024);
    PrimitivePair* place = found_.pairs.data() + found_.count;
    for (Index k = 0; k < width; ++k) {
      *place = {primitive, others[k]};
      place += hit[at(k)];
    }
    found_.count = static_cast<std::size_t>(place - found_.pairs.data());
  }

  const Node& queries_;
  const Index* primitives_;
  Index block_;  // of the queries if the tree is their own, else before all
  const Bvh& tree_;
  const GroupTable& groups_;
  PairBuffer& found_;
  Bounds bounds_;
  std::int32_t active_;
};

void Bvh::overlaps_of_block(Index block, const Bvh& other, const GroupTable& groups, PairBuffer& found) const {
  if (other.size_ > 0) Traversal(*this, block, other, groups, found).run();
}

std::vector<std::pair<Index, Index>> Bvh::overlapping_pairs(const Bvh& a, const Bvh& b, const Execution& execution) {
  constexpr Index blocks_per_chunk = 32;
  std::vector<PairBuffer> chunks(at(Execution::chunk_count(a.block_count(), blocks_per_chunk)));
  execution.for_chunks(a.block_count(), blocks_per_chunk, [&](Index begin, Index end, Index chunk) {
    for (Index block = begin; block < end; ++block) a.overlaps_of_block(block, b, {}, chunks[at(chunk)]);
  });
  std::vector<std::pair<Index, Index>> pairs;
  for (const PairBuffer& chunk : chunks)
    for (std::size_t k = 0; k < chunk.count; ++k) pairs.emplace_back(chunk.pairs[k].first, chunk.pairs[k].second);
  return pairs;
}

std::vector<std::pair<Index, Index>> Bvh::overlapping_pairs(const Bvh& tree, const Execution& execution) {
  return overlapping_pairs(tree, tree, execution);
}

}  // namespace stiv
