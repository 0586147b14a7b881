// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "penetration/crossings.hpp"

namespace stiv {

/// The winding number of a closed body around a point: 1 inside a body that faces outward. Exact, along a ray.
/// @param perturbation of the point, see PerturbedSign
int winding_number(const PlacedBody& closed, const Vector3& point, int perturbation);

/// The winding number of the other body, which is closed, around each vertex of a side's body: along a ray from one
/// vertex of each component, and from there along edges by their crossings.
std::vector<int> winding_numbers(const Crossings& crossings, std::size_t side);

/// For each triangle of a side's body, the mean winding number of the other body, which is closed, over its points: the
/// fraction of its area inside a body that faces outward. (mathematics.md, "Excluded pairs")
std::vector<double> mean_windings(const Crossings& crossings, std::size_t side);

}  // namespace stiv
