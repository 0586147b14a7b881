// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/detector.hpp"

namespace stiv {

/// Is the linear step start -> end free, and its end free of intersections, given that its start is? Conservative
/// continuous check of the path, then the exact static test: the two conditions of an accepted state.
/// (mathematics.md, "Guarantee")
bool is_step_free(Detector& detector, IntersectionTest& intersections, const PositionsView& start,
                  const PositionsView& end, Proximity proximity, Execution& execution);

}  // namespace stiv
