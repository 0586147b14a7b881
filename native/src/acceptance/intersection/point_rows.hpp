// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/execution.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// A point as vector code loads it at once.
struct alignas(32) PointRow {
  double coordinates[4];  ///< x, y, z, 0
};

using PointRows = std::vector<PointRow>;

/// Positions, (N, 3), as such rows.
PointRows point_rows(const PositionsView& q, const Execution& execution);

}  // namespace stiv
