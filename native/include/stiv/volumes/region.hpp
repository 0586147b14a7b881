// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The barycentric cell of a vertex with its earliest event. [P4, "Interference prisms"]
struct Region {
  Index vertex = 0;
  Index event = 0;     ///< index into the events
  bool rigid = false;  ///< true if the event involves a rigid body
};

/// The regions of a step, sorted by vertex. Each event belongs to one region on each side, that of the vertex with the
/// largest weight. A region has its earliest event with a usable normal (n . Drho < -1e-8 |Drho|), the first of equals.
/// The normals of some events are unstable: closest points on a vertex or edge of the face, or at an end of an edge,
/// and nearly parallel edges. They count only if there are no others. If events have no region, no direction resolves
/// them, and the edit must be truncated.
///
/// A rigid body has six degrees of freedom, so its first contact determines the motion of its other vertices. For a
/// pair with a rigid body, only events of nearly the earliest time count, in at most 32 evenly chosen regions.
/// (mathematics.md, "Rigid bodies")
/// @param start, end the step, (N, 3) each
std::vector<Region> earliest_regions(const Surface& surface, const Events& events, const Positions& start,
                                     const Positions& end);

/// A region for each event, on its first side only; events of rigid bodies as above. For local metrics, where each
/// contact can be resolved by itself (Metric::is_local). Not sorted by vertex.
std::vector<Region> contact_regions(const Surface& surface, const Events& events, const Positions& start,
                                    const Positions& end);

}  // namespace stiv
