// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "stiv/types.hpp"

namespace stiv {

/// A finite point, and whose it is: side by side, because splitting goes over all of them many times.
struct alignas(16) NumberedPoint {
  std::array<float, 3> position;
  Index number;  ///< at least 0, no two equal
};

/// Moves the `half` first along the longest axis to the front. Equal positions are told apart by number, so that which
/// ones these are depends on the points alone. The order within both parts depends on the order before.
void split_at_median(std::span<NumberedPoint> points, std::size_t half);

}  // namespace stiv
