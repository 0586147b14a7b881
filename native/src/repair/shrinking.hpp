// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "repair/contraction_tries.hpp"

namespace stiv {

/// Shrinks connected components evenly toward their middles, smaller ones first, each until it meets no other, by the
/// factor that leaves the fewest pairs if none leaves none. What intersects within a component is not changed by that.
/// @param options max_steps of each component, and storage
Contracted shrink_components(const CagedSurface& caged, const Movable& movable, const ContractionOptions& options,
                             const Controls& start, Execution& execution);

}  // namespace stiv
