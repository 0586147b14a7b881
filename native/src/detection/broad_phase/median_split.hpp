// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "stiv/types.hpp"

namespace stiv {

/// A finite point and its index, adjacent in memory because splitting reads them many times.
struct alignas(16) NumberedPoint {
  std::array<float, 3> position;
  Index number;  ///< at least 0, no two equal
};

/// Moves the first `half` points along the longest axis to the front. Ties are broken by number, so the split depends
/// only on the points. The order within each side depends on the previous order.
void split_at_median(std::span<NumberedPoint> points, std::size_t half);

}  // namespace stiv
