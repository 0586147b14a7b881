// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// M x, (rows, 3). The order of additions depends only on the rows, and none is fused: same bits for any vector width
/// and number of threads.
Positions weighted_sums(const WeightMatrix& matrix, const Controls& x, const Execution& execution);

/// The given rows of M x, (k, 3), bit for bit the same.
Positions weighted_sums(const WeightMatrix& matrix, std::span<const Index> rows, const Controls& x,
                        const Execution& execution);

}  // namespace stiv
