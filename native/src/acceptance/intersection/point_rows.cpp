// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/point_rows.hpp"

namespace stiv {

PointRows point_rows(const PositionsView& q, const Execution& execution) {
  constexpr Index chunk_size = 8192;
  PointRows rows(static_cast<std::size_t>(q.rows()));
  execution.for_chunks(static_cast<Index>(q.rows()), chunk_size, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex)
      rows[at(vertex)] = {{q(vertex, 0), q(vertex, 1), q(vertex, 2), 0}};
  });
  return rows;
}

}  // namespace stiv
