// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// M x, (rows, 3), in an order of additions that depends on the rows alone, none fused: the result is the same to the
/// last bit whatever the width of the vectors and the number of threads.
Positions weighted_sums(const WeightMatrix& matrix, const Controls& x, const Execution& execution);

/// Some rows of that, (k, 3), with the same bits.
Positions weighted_sums(const WeightMatrix& matrix, std::span<const Index> rows, const Controls& x,
                        const Execution& execution);

}  // namespace stiv
