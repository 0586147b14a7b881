// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/execution.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Indices of primitives with the given centers (finite), ordered so that runs of `block`, 2 `block`, 4 `block` and so
/// on are close together in space. Each block holds primitives of one group (`groups` empty: a single group) and is
/// padded with -1. The same for any number of threads.
std::vector<Index> block_order(const std::vector<Eigen::Vector3f>& centres, const std::vector<Index>& groups,
                               Index block, const Execution& execution);

/// The same for `items`, all indices in a spatial order: only what is close together there is sorted.
std::vector<Index> block_order_along(std::vector<Index> items, const std::vector<Eigen::Vector3f>& centres,
                                     const std::vector<Index>& groups, Index block, const Execution& execution);

}  // namespace stiv
