// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"
#include "stiv/volumes/patch.hpp"
#include "stiv/volumes/region.hpp"

namespace stiv {

/// A space-time interference volume (STIV) and its gradient with respect to the positions at the end of the step.
struct Stiv {
  double volume = 0;     ///< sum_i A_i min(n . sum_k w_k q1_k - target, -target / 1000); negative
  SparseField gradient;  ///< sum_i A_i w_k n at vertex k
};

/// The STIVs of a step, one for each patch. [P3.1, Eq. 1; P4, Eq. 3; mathematics.md, "Gradient"]
/// @param end q1, (N, 3)
/// @param areas A_i, (N), constant during an edit
std::vector<Stiv> interference_volumes(const Events& events, const std::vector<Region>& regions,
                                       const std::vector<Index>& labels, const Positions& end,
                                       const Eigen::VectorXd& areas);

/// The areas A_i, (N), at positions q: barycentric areas. Vertices without area, which can collide too, have the mean
/// of the others.
Eigen::VectorXd region_areas(const Surface& surface, const Positions& q);
/// Gives vertices without area the mean of the others; 1 if no vertex has any.
void substitute_missing_areas(Eigen::VectorXd& areas);

}  // namespace stiv
