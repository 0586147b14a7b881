// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "large_array.hpp"

namespace stiv {

/// A point that vector code loads at once.
struct alignas(32) PackedPoint {
  double coordinates[4];  ///< x, y, z, 0
};

using PackedPoints = LargeArray<PackedPoint>;

}  // namespace stiv
