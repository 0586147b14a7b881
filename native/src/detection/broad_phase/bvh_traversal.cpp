// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#ifndef STIV_BVH_TRAVERSAL_TYPES
#define STIV_BVH_TRAVERSAL_TYPES

namespace stiv {

/// For each set of eight lanes, its lanes in ascending order, then zeros.
[[maybe_unused]] constexpr std::array<std::array<std::uint8_t, 8>, 256> lanes_of_bits = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (unsigned bits = 0; bits < table.size(); ++bits)
    for (unsigned lane = 0, count = 0; lane < 8; ++lane)
      if ((bits >> lane & 1U) != 0) table[bits][count++] = static_cast<std::uint8_t>(lane);
  return table;
}();

/// The arrays of a tree, without the containers that own them.
struct TreeView {
  static constexpr std::size_t most_levels = 12;  // 8^11 > 2^31

  explicit TreeView(const Bvh& tree)
      : order(tree.order().data()), corners(tree.corners().data()), corner_size(tree.corner_size()) {
    for (std::size_t level = 0; level < tree.levels().size(); ++level) {
      nodes[level] = tree.levels()[level].nodes.data();
      boxes[level] = tree.levels()[level].boxes.data();
      groups[level] = tree.levels()[level].groups.data();
    }
  }

  // Not initialized: a step has hundreds of short tasks.
  std::array<const Bvh::Node*, most_levels> nodes;
  std::array<const PackedBox*, most_levels> boxes;
  std::array<const Index*, most_levels> groups;
  const Index* order;
  const Index* corners;
  Index corner_size;
};

/// Two trees and where their pairs go. `meets` is null if all groups meet, `frames` if they have the same frame.
struct Traversal {
  TreeView a, b;
  bool same_tree;
  const GroupTable* meets;
  const GroupFrames* frames;
  PairBuffer* found;

  Index group(const Bvh::Task& pair) const { return a.groups[pair.level][pair.node]; }
  Index other_group(const Bvh::Task& pair) const { return b.groups[pair.other_level][pair.other_node]; }

  bool groups_meet(const Bvh::Task& pair) const {
    if (meets == nullptr) return true;
    const Index first = group(pair), second = other_group(pair);
    return first == Bvh::mixed || second == Bvh::mixed || meets->meet(first, second);
  }

  /// Whether the children of both nodes have the same groups as they.
  bool has_uniform_groups(const Bvh::Task& pair) const {
    return group(pair) != Bvh::mixed && other_group(pair) != Bvh::mixed;
  }

  /// Of boxes of the first node, in the frame of the second.
  BoxGrowth growth(const Bvh::Task& pair) const { return frames->growth(group(pair), other_group(pair)); }

  /// Makes room for the pairs of some primitives with a block each, and for their corners if these are passed on.
  void reserve(std::size_t primitives, bool with_corners) const {
    const std::size_t most = found->count + (primitives + 1) * Bvh::width;
    const std::vector<Index>& last = with_corners ? found->corners.back() : found->second;
    if (most > last.size()) grow(*found, 2 * most, with_corners);
  }
  static void grow(PairBuffer& buffer, std::size_t size, bool with_corners);

  /// Passes on the pairs if they are many. False if no more are wanted.
  bool wants_more() const { return found->count < found->limit || found->full(*found); }
};

}  // namespace stiv

#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/broad_phase/bvh_traversal.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "hwy/cache_control.h"
#include "vector/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 8>;
using Ints = hn::RebindToSigned<Floats>;
using FloatMask = hn::Mask<Floats>;

constexpr std::size_t width = 8;
constexpr unsigned all_children = 0xFF, all_but_last = 0x7F;  // within a block, the last one has none behind it

/// A box as its numbers lie in memory: those of a PackedBox follow each other, those of a child of a node do not.
template <std::size_t stride>
struct BoxView {
  const float* values;

  HWY_INLINE hn::Vec<Floats> all(std::size_t k) const { return hn::Set(Floats(), values[k * stride]); }
};

HWY_INLINE BoxView<1> view(const PackedBox& box) { return {box.values.data()}; }
HWY_INLINE BoxView<width> child(const Bvh::Node& node, std::size_t lane) { return {&node.planes[0][lane]}; }

template <class Box>
HWY_INLINE hn::Vec<Floats> opposed(const Bvh::Node& node, Box box, std::size_t plane, std::size_t opposite,
                                   std::size_t lane) {
  return hn::Add(hn::Load(Floats(), node.planes[plane] + lane), box.all(opposite));
}

/// Lanes of a node, starting at `lane`, that may meet a box (see may_meet).
template <class Box>
HWY_INLINE FloatMask meeting_lanes(const Bvh::Node& node, Box box, std::size_t lane) {
  const Floats d;
  const auto x = hn::Max(opposed(node, box, 0, 3, lane), opposed(node, box, 3, 0, lane));
  const auto y = hn::Max(opposed(node, box, 1, 4, lane), opposed(node, box, 4, 1, lane));
  const auto z = hn::Max(opposed(node, box, 2, 5, lane), opposed(node, box, 5, 2, lane));
  const auto rest = hn::Min(hn::Load(d, node.planes[6] + lane), box.all(6));
  return hn::Le(hn::Max(hn::Max(x, y), hn::Max(z, rest)), hn::Zero(d));
}

HWY_INLINE unsigned bits_of(FloatMask mask) {
  unsigned char bits[8] = {};
  hn::StoreMaskBits(Floats(), mask, bits);
  return bits[0];
}

/// A bit for each of the eight children that may meet a box.
HWY_INLINE unsigned meeting_children(const Bvh::Node& node, const PackedBox& box) {
  const Floats d;
  unsigned bits = 0;
  for (std::size_t lane = 0; lane < width; lane += hn::Lanes(d))
    bits |= bits_of(meeting_lanes(node, view(box), lane)) << lane;
  return bits;
}

/// The children of a node, as large as they are in another frame.
HWY_INLINE Bvh::Node grown_children(const Bvh::Node& node, const BoxGrowth& growth) {
  const Floats d;
  Bvh::Node result = node;
  for (std::size_t plane = 0; plane < growth.values.size(); ++plane)
    for (std::size_t lane = 0; lane < width; lane += hn::Lanes(d)) {
      const auto sum = hn::Add(hn::Load(d, node.planes[plane] + lane), hn::Set(d, growth.values[plane]));
      hn::Store(hn::Max(sum, hn::Set(d, std::numeric_limits<float>::lowest())), d, result.planes[plane] + lane);
    }
  return result;
}

/// Lanes of a block whose primitives have none of the given corners.
template <Index size_a, Index size_b>
HWY_INLINE FloatMask apart_lanes(const Index* own, const Index* others, std::size_t lane, FloatMask mask) {
  const Floats d;
  const Ints i;
  for (std::size_t p = 0; p < size_a; ++p) {
    const auto corner = hn::Set(i, own[p * width]);
    for (std::size_t q = 0; q < size_b; ++q)
      mask = hn::AndNot(hn::RebindMask(d, hn::Eq(hn::LoadU(i, others + q * width + lane), corner)), mask);
  }
  return mask;
}

// Pairs are listed before they are compared: loops over the few children of one pair would end at a branch that no
// processor can predict.

/// Up to `most` pairs of nodes, blocks or primitives.
template <std::size_t most>
struct PairList {
  static constexpr std::size_t capacity = most;

  std::array<Index, most + width> first, second;
  std::size_t count = 0;

  void add(Index node, Index other) {
    first[count] = node;
    second[count++] = other;
  }

  /// The children of a node that are among `bits`, each with the other one.
  HWY_INLINE void add_children(Index node, unsigned bits, Index other) {
    const Ints i;
    const hn::Rebind<std::uint8_t, Ints> bytes;
    for (std::size_t lane = 0; lane < width; lane += hn::Lanes(i)) {
      const auto lanes = hn::PromoteTo(i, hn::LoadU(bytes, lanes_of_bits[bits].data() + lane));
      hn::StoreU(hn::Add(hn::Set(i, node * Bvh::width), lanes), i, first.data() + count + lane);
      hn::StoreU(hn::Set(i, other), i, second.data() + count + lane);
    }
    count += static_cast<std::size_t>(std::popcount(bits));
  }
};

using ParentPairs = PairList<32>;
constexpr std::size_t some_blocks = 64;
using BlockPairs = PairList<some_blocks + ParentPairs::capacity * width * width>;

/// Moves the children of listed pairs, whose children are blocks, to a list of pairs of blocks.
HWY_INLINE void list_blocks(const Traversal& t, ParentPairs& parents, BlockPairs& blocks) {
  PairList<ParentPairs::capacity * width> rows;
  for (std::size_t k = 0; k < parents.count; ++k)
    rows.add_children(parents.first[k],
                      meeting_children(t.a.nodes[1][parents.first[k]], t.b.boxes[1][parents.second[k]]),
                      parents.second[k]);
  parents.count = 0;
  for (std::size_t row = 0; row < rows.count; ++row) {
    const Index block = rows.first[row], other = rows.second[row];
    const unsigned others = meeting_children(t.b.nodes[1][other], t.a.boxes[0][block]);
    const bool same = t.same_tree && block / Bvh::width == other;
    blocks.add_children(other, same ? others & ~0U << block % Bvh::width : others, block);
  }
}

/// Pairs of a primitive of the first tree, given by its place, and a block, with the lanes of that block that it meets.
/// Few primitives meet any but their neighbors, so these lists are short.
template <std::size_t most>
struct HitList {
  std::array<Index, most> place, other;
  std::array<unsigned char, most> lanes;
  std::size_t count = 0;

  /// Without a branch: each row is written, and the count decides whether it stays.
  HWY_INLINE void add(Index first, Index second, unsigned bits) {
    place[count] = first;
    other[count] = second;
    lanes[count] = static_cast<unsigned char>(bits);
    count += bits != 0;
  }
};

/// The primitives of a block, without a common corner, that meet the one in lane `k` of `a`: the first block, as it is
/// in the frame of the other.
template <Index size_a, Index size_b>
HWY_INLINE unsigned met_lanes(const Traversal& t, const Bvh::Node& a, Index block, std::size_t k, Index other) {
  const Floats d;
  const Bvh::Node& b = t.b.nodes[0][other];
  unsigned bits = 0;
  for (std::size_t lane = 0; lane < width; lane += hn::Lanes(d)) {
    FloatMask mask = meeting_lanes(b, child(a, k), lane);
    if constexpr (size_a > 0)
      mask = apart_lanes<size_a, size_b>(t.a.corners + static_cast<std::size_t>(block) * width * size_a + k,
                                         t.b.corners + static_cast<std::size_t>(other) * width * size_b, lane, mask);
    bits |= bits_of(mask) << lane;
  }
  // Within one block, only the primitives behind it: each pair once.
  return t.same_tree && block == other ? bits & (~1U << k) : bits;
}

/// Some of eight numbers.
HWY_INLINE hn::Vec<Ints> chosen(const Index* numbers, hn::Vec<Ints> places) {
  const Ints i;
#if HWY_MAX_BYTES >= 32
  return hn::TableLookupLanes(hn::LoadU(i, numbers), hn::IndicesFromVec(i, places));  // gathers take four times as long
#else
  return hn::GatherIndex(i, numbers, places);
#endif
}

/// Where the numbers of pairs go: each array gets a whole vector.
struct PairSlots {
  Index *first, *second;
  Index* corners[4];

  HWY_INLINE explicit PairSlots(PairBuffer& found) : first(found.first.data()), second(found.second.data()) {
    for (std::size_t k = 0; k < 4; ++k) corners[k] = found.corners[k].data();
  }
};

/// Writes the corners of a vertex and some faces.
HWY_INLINE void write_face_corners(const Index* vertex, const Index* faces, hn::Vec<Ints> lanes, const PairSlots& slots,
                                   std::size_t at) {
  const Ints i;
  hn::StoreU(hn::Set(i, *vertex), i, slots.corners[0] + at);
  for (std::size_t k = 0; k < 3; ++k) hn::StoreU(chosen(faces + k * width, lanes), i, slots.corners[k + 1] + at);
}

/// Writes the corners of an edge and some others, those of the lower one first.
HWY_INLINE void write_edge_corners(const Index* edge, const Index* others, hn::Vec<Ints> lanes,
                                   hn::Mask<Ints> edge_is_lower, const PairSlots& slots, std::size_t at) {
  const Ints i;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto own = hn::Set(i, edge[k * width]), other = chosen(others + k * width, lanes);
    hn::StoreU(hn::IfThenElse(edge_is_lower, own, other), i, slots.corners[k] + at);
    hn::StoreU(hn::IfThenElse(edge_is_lower, other, own), i, slots.corners[k + 2] + at);
  }
}

/// The corners of the primitive at a place of the blocks: one in each array of a block.
template <Index size>
HWY_INLINE const Index* corners_at(const TreeView& tree, Index place) {
  const auto block = static_cast<std::size_t>(place) / width;
  return tree.corners + block * width * static_cast<std::size_t>(size) + static_cast<std::size_t>(place) % width;
}

/// Passes on the pairs of a list.
template <Index size_a, Index size_b, std::size_t most>
HWY_INLINE void pass_on(const Traversal& t, const HitList<most>& hits) {
  const Ints i;
  const hn::Rebind<std::uint8_t, Ints> bytes;
  constexpr bool with_corners = size_a + size_b == 4;
  t.reserve(hits.count, with_corners);
  const PairSlots slots(*t.found);
  std::size_t count = t.found->count;
  for (std::size_t hit = 0; hit < hits.count; ++hit) {
    const auto first = hn::Set(i, t.a.order[hits.place[hit]]);
    const Index other = hits.other[hit] * Bvh::width;
    for (std::size_t lane = 0; lane < width; lane += hn::Lanes(i)) {
      const auto lanes = hn::PromoteTo(i, hn::LoadU(bytes, lanes_of_bits[hits.lanes[hit]].data() + lane));
      const auto second = chosen(t.b.order + other, lanes);
      hn::StoreU(first, i, slots.first + count + lane);
      hn::StoreU(second, i, slots.second + count + lane);
      if constexpr (with_corners) {
        const Index* const own = corners_at<size_a>(t.a, hits.place[hit]);
        const Index* const others = corners_at<size_b>(t.b, other);
        if constexpr (size_a == 1)
          write_face_corners(own, others, lanes, slots, count + lane);
        else
          write_edge_corners(own, others, lanes, hn::Lt(first, second), slots, count + lane);
      }
    }
    count += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(hits.lanes[hit])));
  }
  t.found->count = count;
}

template <Index size_a, Index size_b>
void meet_grown_blocks(const Traversal& t, Index block, Index other, const Bvh::Node& a) {
  HitList<width> hits;
  for (unsigned left = meeting_children(a, t.b.boxes[0][other]); left != 0; left &= left - 1) {
    const int k = std::countr_zero(left);
    hits.add(block * Bvh::width + k, other, met_lanes<size_a, size_b>(t, a, block, static_cast<std::size_t>(k), other));
  }
  pass_on<size_a, size_b>(t, hits);
}

/// Fetches the boxes of a block.
HWY_INLINE void prefetch(const Bvh::Node& block) {
  constexpr std::size_t planes_of_line = 64 / sizeof(block.planes[0]);
  for (std::size_t plane = 0; plane < 8; plane += planes_of_line) hwy::Prefetch(block.planes[plane]);
}

/// Compares listed blocks, of which the second ones are those of the first tree, and empties the lists. False if the
/// traversal ends.
template <Index size_a, Index size_b>
bool meet_listed(const Traversal& t, ParentPairs& parents, BlockPairs& blocks) {
  list_blocks(t, parents, blocks);
  for (std::size_t begin = 0; begin < blocks.count; begin += some_blocks) {
    PairList<some_blocks * width> rows;
    for (std::size_t k = begin; k < std::min(begin + some_blocks, blocks.count); ++k) {
      const Index block = blocks.second[k], other = blocks.first[k];
      prefetch(t.b.nodes[0][other]);  // for the rows, once all of them are listed
      const unsigned partners = t.same_tree && block == other ? all_but_last : all_children;
      rows.add_children(block, partners & meeting_children(t.a.nodes[0][block], t.b.boxes[0][other]), other);
    }
    HitList<some_blocks * width> hits;
    for (std::size_t row = 0; row < rows.count; ++row) {
      const Index place = rows.first[row], block = place / Bvh::width;
      hits.add(place, rows.second[row],
               met_lanes<size_a, size_b>(t, t.a.nodes[0][block], block, static_cast<std::size_t>(place % Bvh::width),
                                         rows.second[row]));
    }
    pass_on<size_a, size_b>(t, hits);
    if (!t.wants_more()) return false;
  }
  blocks.count = 0;
  return true;
}

/// Boxes of a pair of nodes, each as the other one's frame sees it.
template <bool grow>
struct FramedBoxes {
  BoxGrowth growth, opposite;

  HWY_INLINE PackedBox first(const PackedBox& box) const { return grow ? grown(box, growth) : box; }
  HWY_INLINE PackedBox second(const PackedBox& box) const { return grow ? grown(box, opposite) : box; }
};

/// Puts pairs of children of two nodes onto the stack, unless both are blocks.
template <bool grow>
HWY_INLINE void meet_nodes(const Traversal& t, const Bvh::Task& pair, const FramedBoxes<grow>& framed, Bvh::Task* stack,
                           std::size_t& top) {
  const auto level = static_cast<std::size_t>(pair.level), other_level = static_cast<std::size_t>(pair.other_level);
  const Bvh::Node &node = t.a.nodes[level][pair.node], &other = t.b.nodes[other_level][pair.other_node];
  if (level > other_level) {
    unsigned left = meeting_children(node, framed.second(t.b.boxes[other_level][pair.other_node]));
    for (; left != 0; left &= left - 1)
      stack[top++] = {pair.level - 1, pair.node * Bvh::width + std::countr_zero(left), pair.other_level,
                      pair.other_node};
  } else if (level < other_level) {
    unsigned left = meeting_children(other, framed.first(t.a.boxes[level][pair.node]));
    for (; left != 0; left &= left - 1)
      stack[top++] = {pair.level, pair.node, pair.other_level - 1,
                      pair.other_node * Bvh::width + std::countr_zero(left)};
  } else {
    const bool same = t.same_tree && pair.node == pair.other_node;
    unsigned left = meeting_children(node, framed.second(t.b.boxes[other_level][pair.other_node]));
    for (; left != 0; left &= left - 1) {
      const int k = std::countr_zero(left);
      const Index child = pair.node * Bvh::width + k;
      unsigned others = meeting_children(other, framed.first(t.a.boxes[level - 1][child]));
      if (same) others &= ~0U << k;
      for (; others != 0; others &= others - 1)
        stack[top++] = {pair.level - 1, child, pair.level - 1, pair.other_node * Bvh::width + std::countr_zero(others)};
    }
  }
}

template <Index size_a, Index size_b>
void descend(const Traversal& t, const Bvh::Task& root) {
  // Each step down leaves at most 63 other pairs behind, and there are at most 22 steps. Not initialized: clearing it
  // for each task would take longer than some tasks.
  std::array<Bvh::Task, 1536> stack;
  ParentPairs parents;
  BlockPairs blocks;
  std::size_t top = 0;
  stack[top++] = root;
  while (top > 0) {
    const Bvh::Task pair = stack[--top];
    if (!t.groups_meet(pair)) continue;
    const BoxGrowth growth = t.frames == nullptr ? BoxGrowth() : t.growth(pair);
    const bool grows = t.frames != nullptr && !growth.is_none;
    if (pair.level == 1 && pair.other_level == 1 && !grows && t.has_uniform_groups(pair)) {
      parents.add(pair.node, pair.other_node);
    } else if (pair.level + pair.other_level > 0) {
      if (grows)
        meet_nodes(t, pair, FramedBoxes<true>{growth, growth.opposite()}, stack.data(), top);
      else
        meet_nodes(t, pair, FramedBoxes<false>(), stack.data(), top);
      continue;
    } else if (grows) {
      meet_grown_blocks<size_a, size_b>(t, pair.node, pair.other_node, grown_children(t.a.nodes[0][pair.node], growth));
      if (!t.wants_more()) return;
    } else {
      blocks.add(pair.other_node, pair.node);
    }
    const bool many = parents.count == ParentPairs::capacity || blocks.count == some_blocks;
    if (many && !meet_listed<size_a, size_b>(t, parents, blocks)) return;
  }
  meet_listed<size_a, size_b>(t, parents, blocks);
}

void traverse_trees(const Traversal& traversal, const Bvh::Task& task) {
  const Index a = traversal.a.corner_size, b = traversal.b.corner_size;
  if (a == 1 && b == 3)
    descend<1, 3>(traversal, task);
  else if (a == 2 && b == 2)
    descend<2, 2>(traversal, task);
  else if (a == 3 && b == 3)
    descend<3, 3>(traversal, task);
  else
    descend<0, 0>(traversal, task);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void Traversal::grow(PairBuffer& buffer, std::size_t size, bool with_corners) {
  buffer.first.resize(size);
  buffer.second.resize(size);
  if (!with_corners) return;
  for (std::vector<Index>& corners : buffer.corners) corners.resize(size);
}

void Bvh::overlaps(const Task& task, const Bvh& other, const GroupRelations& groups, PairBuffer& found) const {
  const Traversal traversal{TreeView(*this),
                            TreeView(other),
                            this == &other,
                            groups.table.empty() ? nullptr : &groups.table,
                            groups.frames.are_alike() ? nullptr : &groups.frames,
                            &found};
  STIV_FOR_VECTOR_TARGET(traverse_trees)(traversal, task);
}

}  // namespace stiv
#endif
