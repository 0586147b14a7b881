// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/bvh.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/broad_phase/bvh_refit.cpp"
#include "vector/foreach_target.hpp"

#include "vector/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

/// Boxes of the children of a node.
struct Children {
  PackedBox boxes[Bvh::width];

  HWY_INLINE void set(std::size_t k, const PackedBox& box) { boxes[k] = box; }
  HWY_INLINE void include(std::size_t k, const PackedBox& box) { boxes[k].include(box); }
  HWY_INLINE void store(Bvh::Node& node, PackedBox& whole) const {
    whole = boxes[0];
    for (std::size_t k = 0; k < Bvh::width; ++k) {
      whole.include(boxes[k]);
      for (std::size_t plane = 0; plane < 8; ++plane) node.planes[plane][k] = boxes[k].values[plane];
    }
  }
};

#else

using Four = hn::FixedTag<float, 4>;
using FourLanes = hn::Vec<Four>;

/// Boxes of the children of a node.
struct Children {
  FourLanes low[Bvh::width], high[Bvh::width];

  HWY_INLINE void set(std::size_t k, const PackedBox& box) {
    low[k] = hn::Load(Four(), box.values.data());
    high[k] = hn::Load(Four(), box.values.data() + 4);
  }
  HWY_INLINE void include(std::size_t k, const PackedBox& box) {
    low[k] = hn::Min(low[k], hn::Load(Four(), box.values.data()));
    high[k] = hn::Min(high[k], hn::Load(Four(), box.values.data() + 4));
  }
  HWY_INLINE void store(Bvh::Node& node, PackedBox& whole) const {
    for (std::size_t half = 0; half < Bvh::width; half += 4) {
      store_transposed(low + half, node.planes, half);
      store_transposed(high + half, node.planes + 4, half);
    }
    hn::Store(least(low), Four(), whole.values.data());
    hn::Store(least(high), Four(), whole.values.data() + 4);
  }

  static HWY_INLINE FourLanes least(const FourLanes* rows) {
    const FourLanes a = hn::Min(rows[0], rows[1]), b = hn::Min(rows[2], rows[3]);
    const FourLanes c = hn::Min(rows[4], rows[5]), e = hn::Min(rows[6], rows[7]);
    return hn::Min(hn::Min(a, b), hn::Min(c, e));
  }
  static HWY_INLINE void store_transposed(const FourLanes* rows, float (*planes)[Bvh::width], std::size_t lane) {
    const Four d;
    const FourLanes even01 = hn::InterleaveLower(d, rows[0], rows[1]);
    const FourLanes even23 = hn::InterleaveLower(d, rows[2], rows[3]);
    const FourLanes odd01 = hn::InterleaveUpper(d, rows[0], rows[1]);
    const FourLanes odd23 = hn::InterleaveUpper(d, rows[2], rows[3]);
    hn::Store(hn::ConcatLowerLower(d, even23, even01), d, planes[0] + lane);
    hn::Store(hn::ConcatUpperUpper(d, even23, even01), d, planes[1] + lane);
    hn::Store(hn::ConcatLowerLower(d, odd23, odd01), d, planes[2] + lane);
    hn::Store(hn::ConcatUpperUpper(d, odd23, odd01), d, planes[3] + lane);
  }
};

#endif

/// `corners`: of a block, one array for each corner.
template <std::size_t size>
HWY_INLINE void refit_block(const Index* corners, const PackedBox* vertices, const PackedBox& absent, Bvh::Node& node,
                            PackedBox& box) {
  Children children;
  for (std::size_t k = 0; k < Bvh::width; ++k) {
    if (corners[k] < 0) {
      children.set(k, absent);
      continue;
    }
    children.set(k, vertices[corners[k]]);
    for (std::size_t corner = 1; corner < size; ++corner)
      children.include(k, vertices[corners[corner * Bvh::width + k]]);
  }
  children.store(node, box);
}

template <std::size_t size>
void refit_blocks_of_size(const Index* blocks, Index begin, Index end, const Index* corners, const PackedBox* vertices,
                          Bvh::Level& level) {
  const PackedBox absent = PackedBox::empty();
  for (Index k = begin; k < end; ++k) {
    const auto block = static_cast<std::size_t>(blocks == nullptr ? k : blocks[k]);
    refit_block<size>(corners + block * size * Bvh::width, vertices, absent, level.nodes.data()[block],
                      level.boxes.data()[block]);
  }
}

void refit_blocks(Index size, const Index* blocks, Index begin, Index end, const Index* corners,
                  const PackedBox* vertices, Bvh::Level& level) {
  if (size == 1)
    refit_blocks_of_size<1>(blocks, begin, end, corners, vertices, level);
  else if (size == 2)
    refit_blocks_of_size<2>(blocks, begin, end, corners, vertices, level);
  else
    refit_blocks_of_size<3>(blocks, begin, end, corners, vertices, level);
}

void summarise_nodes(std::span<const PackedBox> below, const Index* nodes, Index begin, Index end, Bvh::Level& level) {
  const PackedBox absent = PackedBox::empty();
  for (Index k = begin; k < end; ++k) {
    const auto node = static_cast<std::size_t>(nodes == nullptr ? k : nodes[k]);
    Children children;
    for (std::size_t lane = 0; lane < Bvh::width; ++lane) {
      const std::size_t child = node * Bvh::width + lane;
      children.set(lane, child < below.size() ? below.data()[child] : absent);
    }
    children.store(level.nodes.data()[node], level.boxes.data()[node]);
  }
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void Bvh::refit_blocks(const Index* blocks, Index begin, Index end, std::span<const Index> corners,
                       const PackedBox* vertices) {
  if (begin == end) return;
  const auto size = static_cast<Index>(corners.size() / order_.size());
  STIV_FOR_VECTOR_TARGET(refit_blocks)(size, blocks, begin, end, corners.data(), vertices, levels_[0]);
}

void Bvh::summarise(std::size_t level, const Index* nodes, Index begin, Index end) {
  STIV_FOR_VECTOR_TARGET(summarise_nodes)(levels_[level - 1].boxes, nodes, begin, end, levels_[level]);
}

}  // namespace stiv
#endif
