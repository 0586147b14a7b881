// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <memory>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The pairs of triangles that are apart at q, (N, 3), but so near that moving each point by less than `distance` can
/// make them intersect: rounding decides then. Triangles with a common vertex or edge count too, if they are nearly
/// folded onto each other.
/// @param bodies pairs of bodies, smaller index first, sorted; other pairs are left out
IndexPairs find_touching(const std::shared_ptr<const Surface>& surface, const IndexPairs& bodies,
                         const PositionsView& q, double distance, Execution& execution);

/// Bound of the depth to which two triangles intersect: the shortest motion that parts them, along the normals of
/// faces and edges of both. Corners that they share do not count as an intersection.
double intersection_depth(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                          const PositionsView& q);

/// The distance of the two primitives of an event at other positions.
double primitive_distance(const Event& event, const std::function<Vector3(Index)>& position);

}  // namespace stiv
