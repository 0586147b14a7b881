// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace stiv {

/// A point that vector code loads at once.
struct alignas(32) PackedPoint {
  double coordinates[4];  ///< x, y, z, 0
};

using PackedPoints = std::vector<PackedPoint>;

}  // namespace stiv
