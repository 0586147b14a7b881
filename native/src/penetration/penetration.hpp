// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "penetration/body_mesh.hpp"
#include "stiv/acceptance/intersections.hpp"

namespace stiv {

/// The penetration of a body into a closed one.
struct Penetration {
  double amount = 0;       ///< a volume, or an area
  double uncertainty = 0;  ///< its largest change if vertices move by `rounding`
};

/// The common volume V of two closed bodies. By the divergence theorem, with winding numbers w, 3 V is the integral of
/// w_b x.n over the surface of a plus that of w_a x.n over the surface of b. Negative if one of them faces inward.
/// @param candidates pairs of their triangles, all intersecting ones included
Penetration common_volume(const PlacedBody& a, const PlacedBody& b, const IndexPairs& candidates, double rounding);

/// The area of an open body inside a closed one, plus half of the area on its surface. Negative if the closed body
/// faces inward.
/// @param start_areas of the open body's triangles at the start, so that stretching does not change the result
Penetration area_inside(const PlacedBody& open, const std::vector<double>& start_areas, const PlacedBody& closed,
                        const IndexPairs& candidates, double rounding);

/// The length of the curve in which two bodies intersect.
/// @param candidates pairs of their triangles, all intersecting ones included
Penetration intersection_length(const PlacedBody& a, const PlacedBody& b, const IndexPairs& candidates,
                                double rounding);

}  // namespace stiv
