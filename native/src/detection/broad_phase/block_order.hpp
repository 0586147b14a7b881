// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "detection/broad_phase/numbered_point.hpp"
#include "stiv/execution.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// The numbers of primitives with the given centers, ordered so that runs of `block`, 2 `block`, 4 `block` and so on
/// are close together in space. Each block (a power of two, at most 512) holds primitives of one group (`groups` by
/// number, empty: a single group) and is padded with -1. The same for any number of threads.
LargeArray<Index> block_order(NumberedPoints centres, std::span<const Index> groups, Index block,
                              const Execution& execution);

/// The same for centers in a spatial order: only what is close together there is sorted.
LargeArray<Index> block_order_along(NumberedPoints centres, std::span<const Index> groups, Index block,
                                    const Execution& execution);

}  // namespace stiv
