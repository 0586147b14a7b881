// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/detector.hpp"

namespace stiv {

/// Marks the vertices, (N), whose positions differ in any bit.
std::vector<unsigned char> moved_vertices(const PositionsView& start, const PositionsView& end,
                                          const Execution& execution);

/// True if the linear step start -> end, (N, 3) each, is proven free of interference and its end free of intersections.
/// The start must be free. These are the two conditions of an accepted state: a conservative continuous test of the
/// path, then the exact static test. (mathematics.md, "Guarantee")
bool is_step_free(Detector& detector, IntersectionTest& intersections, const PositionsView& start,
                  const PositionsView& end, Proximity proximity, Execution& execution);

}  // namespace stiv
