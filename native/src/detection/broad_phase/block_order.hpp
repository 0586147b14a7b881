// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Numbers of things with the given centres (finite) in an order in which runs of `block` of them, runs of 2 `block`,
/// 4 `block` and so on lie near each other. Each block holds things of one group (`groups` empty: all of one) and is
/// filled up with -1.
std::vector<Index> block_order(const std::vector<Eigen::Vector3f>& centres, const std::vector<Index>& groups,
                               Index block);

}  // namespace stiv
