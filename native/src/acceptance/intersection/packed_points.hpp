// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/execution.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// A point that vector code loads at once.
struct alignas(32) PackedPoint {
  double coordinates[4];  ///< x, y, z, 0
};

using PackedPoints = std::vector<PackedPoint>;

/// Packs positions, (N, 3).
inline PackedPoints pack_points(const PositionsView& q, const Execution& execution) {
  constexpr Index chunk_size = 8192;
  PackedPoints rows(static_cast<std::size_t>(q.rows()));
  execution.for_chunks(static_cast<Index>(q.rows()), chunk_size, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex)
      rows[at(vertex)] = {{q(vertex, 0), q(vertex, 1), q(vertex, 2), 0}};
  });
  return rows;
}

}  // namespace stiv
