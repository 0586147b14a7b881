// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Finds the blocks of a tree that hold a primitive with some vertex, among the first vertices. Most primitives at a
/// vertex share a block, so there are far fewer blocks than primitives at it.
class BlockIncidence {
 public:
  /// @param corners (blocks, block_size) vertices of each block's primitives, -1: none
  BlockIncidence(std::span<const Index> corners, std::size_t block_size, Index vertex_count)
      : first_(static_cast<std::size_t>(vertex_count) + 1, 0) {
    for_each_once(corners, block_size, [&](std::size_t vertex, Index) { ++first_[vertex]; });
    Index sum = 0;
    for (Index& first : first_) first = sum += first;  // where the vertex ends: filled from the back
    blocks_.resize(static_cast<std::size_t>(sum));
    for_each_once(corners, block_size, [&](std::size_t vertex, Index block) {
      blocks_[static_cast<std::size_t>(--first_[vertex])] = block;
    });
  }

  /// The blocks of each of the vertices `begin` to `end`, some of them repeatedly.
  std::span<const Index> blocks_at(Index begin, Index end) const {
    return {blocks_.data() + first_[begin], blocks_.data() + first_[end]};
  }

 private:
  /// Are all vertices of a block beyond the first ones? Compilers turn this into vector code.
  bool is_unlisted(std::span<const Index> corners) const {
    const auto count = static_cast<Index>(first_.size() - 1);
    Index signs = 0;
    for (const Index corner : corners) signs |= (corner - count) & ~corner;
    return signs >= 0;
  }

  template <class Visit>
  void for_each_once(std::span<const Index> corners, std::size_t block_size, const Visit& visit) const {
    std::vector<Index> last(first_.size(), -1);  // block of each vertex
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
      if (corner % block_size == 0 && is_unlisted(corners.subspan(corner, block_size))) {
        corner += block_size - 1;
        continue;
      }
      const auto block = static_cast<Index>(corner / block_size);
      const bool is_listed = corners[corner] >= 0 && corners[corner] < static_cast<Index>(first_.size()) - 1;
      if (!is_listed || last[corners[corner]] == block) continue;
      last[corners[corner]] = block;
      visit(static_cast<std::size_t>(corners[corner]), block);
    }
  }

  std::vector<Index> first_;  // of each vertex in `blocks_`, and the end
  std::vector<Index> blocks_;
};

}  // namespace stiv
