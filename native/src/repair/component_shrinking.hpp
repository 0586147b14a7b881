// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "repair/contraction_strategies.hpp"

namespace stiv {

/// Shrinks connected components uniformly toward their means, smaller ones first, until each intersects no other. If no
/// factor achieves that, the factor with the fewest pairs is used. Intersections within a component remain. Then each
/// grows as far as that adds no intersections: tiny components would have all their triangles close to each other, and
/// an expansion could only take tiny steps.
/// @param options uses max_steps, for each component, and storage
Contracted shrink_components(const CagedSurface& caged, const Movable& movable, const ContractionOptions& options,
                             const Controls& start, Execution& execution);

}  // namespace stiv
