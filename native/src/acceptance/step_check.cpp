// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/acceptance/step_check.hpp"

namespace stiv {

std::vector<unsigned char> moved_vertices(const PositionsView& start, const PositionsView& end) {
  std::vector<unsigned char> moved;
  moved.reserve(static_cast<std::size_t>(start.rows()));
  for (Index vertex = 0; vertex < start.rows(); ++vertex) moved.push_back(start.row(vertex) != end.row(vertex));
  return moved;
}

bool is_step_free(Detector& detector, IntersectionTest& intersections, const PositionsView& start,
                  const PositionsView& end, Proximity proximity, Execution& execution) {
  return detector.earliest_time(start, end, proximity, execution) == never &&
         intersections.is_free(end, moved_vertices(start, end), execution);
}

}  // namespace stiv
