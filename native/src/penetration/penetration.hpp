// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "penetration/placed_body.hpp"
#include "stiv/acceptance/intersections.hpp"

namespace stiv {

/// How deep a body is in a closed one.
struct Penetration {
  double amount = 0;       ///< a volume, or an area
  double uncertainty = 0;  ///< what it changes by where the bodies move by a given distance, `rounding`
};

/// The volume that two closed bodies have in common, found from their surfaces: with winding numbers w, by the
/// divergence theorem, 3 V = integral of w_b x.n over the surface of a + integral of w_a x.n over that of b. Negative
/// if one of them faces inward.
/// @param meeting pairs of their triangles, among which are all that intersect
Penetration common_volume(const PlacedBody& a, const PlacedBody& b, const IndexPairs& meeting, double rounding);

/// The area of an open body that is inside of a closed one, each triangle counted with its area at the start, so that
/// what stretches goes no deeper; half of what lies in the closed one's surface. Negative if that faces inward.
Penetration area_inside(const PlacedBody& open, const std::vector<double>& start_areas, const PlacedBody& closed,
                        const IndexPairs& meeting, double rounding);

}  // namespace stiv
