// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/acceptance/step_check.hpp"

namespace stiv {

std::vector<unsigned char> moved_vertices(const PositionsView& start, const PositionsView& end,
                                          const Execution& execution) {
  constexpr Index chunk_size = 4096;
  std::vector<unsigned char> moved(at(start.rows()));
  execution.for_chunks(static_cast<Index>(start.rows()), chunk_size, [&](Index first, Index last, Index) {
    for (Index vertex = first; vertex < last; ++vertex) moved[at(vertex)] = start.row(vertex) != end.row(vertex);
  });
  return moved;
}

bool is_step_free(Detector& detector, IntersectionTest& intersections, const PositionsView& start,
                  const PositionsView& end, Proximity proximity, Execution& execution) {
  return detector.earliest_time(start, end, proximity, execution) == never &&
         intersections.is_free(end, moved_vertices(start, end, execution), execution);
}

}  // namespace stiv
