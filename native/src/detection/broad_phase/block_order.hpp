// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "detection/broad_phase/numbered_point.hpp"
#include "stiv/execution.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// The groups of primitives that a tree separates.
struct PrimitiveGroups {
  std::span<const Index> of_primitives;    ///< empty: a single group
  std::span<const unsigned char> at_rest;  ///< 1 for groups that never move, and are never compared with themselves

  PrimitiveGroups() = default;
  PrimitiveGroups(std::span<const Index> groups, std::span<const unsigned char> resting = {})
      : of_primitives(groups), at_rest(resting) {}
  PrimitiveGroups(const std::vector<Index>& groups) : of_primitives(groups) {}

  bool rests(Index group) const { return !at_rest.empty() && at_rest[at(group)] != 0; }
};

/// The numbers of primitives with the given centers, ordered so that runs of `block`, 2 `block`, 4 `block` and so on
/// are close together in space. Each block (a power of two, at most 512) holds primitives of one group (see
/// PrimitiveGroups) and is padded with -1. The same for any number of threads.
LargeArray<Index> block_order(NumberedPoints centres, const PrimitiveGroups& groups, Index block,
                              const Execution& execution);

/// The same for centers in a spatial order: only what is close together there is sorted.
LargeArray<Index> block_order_along(NumberedPoints centres, const PrimitiveGroups& groups, Index block,
                                    const Execution& execution);

/// The primitives of large groups at rest, in blocks of their own, and the others. Both keep a given order.
struct DividedOrder {
  LargeArray<Index> resting_blocks;
  LargeArray<Index> others;
};

/// For primitives along a curve: that is close enough for groups at rest, which then need no centers.
DividedOrder divide_order(std::span<const Index> order, const PrimitiveGroups& groups, Index block);

}  // namespace stiv
