// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "large_array.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// A finite point and its index, adjacent in memory because sorting reads them many times.
struct alignas(16) NumberedPoint {
  std::array<float, 3> position;
  Index number;  ///< at least 0, no two equal
};

using NumberedPoints = LargeArray<NumberedPoint>;

}  // namespace stiv
