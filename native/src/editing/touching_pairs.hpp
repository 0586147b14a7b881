// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The pairs of triangles that are apart at q, (N, 3), but so near that moving each point by less than `distance` can
/// make them intersect: rounding decides then. Triangles with a common vertex or edge count too, if they are nearly
/// folded onto each other.
/// @param bodies pairs of bodies, smaller index first, sorted; other pairs are left out
IndexPairs find_touching(const std::shared_ptr<const Surface>& surface, const IndexPairs& bodies,
                         const PositionsView& q, double distance, Execution& execution);

/// The pairs of triangles of `find_touching`, and those that intersect.
IndexPairs find_contacts(const std::shared_ptr<const Surface>& surface, const IndexPairs& bodies,
                         const PositionsView& q, double distance, Execution& execution);

/// The pairs of some bodies, smaller number first, sorted, that are tested against each other, and whose boxes are no
/// further apart than a distance.
IndexPairs bodies_within_reach(const Surface& surface, const std::vector<Index>& bodies, const PositionsView& q,
                               double distance);

}  // namespace stiv
