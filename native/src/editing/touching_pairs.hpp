// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The pairs of triangles that are apart at q, (N, 3), but so near that moving each point by less than `distance` can
/// make them intersect: rounding decides then. Triangles with a common vertex or edge count too, if they are nearly
/// folded onto each other.
/// @param bodies pairs of bodies, smaller index first, sorted; other pairs are left out
IndexPairs find_touching(const std::shared_ptr<const Surface>& surface, const IndexPairs& bodies,
                         const PositionsView& q, double distance, Execution& execution);

}  // namespace stiv
