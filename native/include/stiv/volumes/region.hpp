// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The barycentric cell of a vertex, with the event it is hit by first. [P4, "Interference prisms"]
struct Region {
  Index vertex = 0;
  Index event = 0;     ///< position in the list of events
  bool rigid = false;  ///< a rigid body takes part in the event
};

/// Each event falls into one region on either side, that of its heaviest vertex; a region keeps the earliest event
/// whose normal is usable (n . Drho < -1e-8 |Drho|). Events whose nearest points lie on a
/// vertex or edge of a face or at an end of an edge, and those of nearly parallel edges, count only if there are no
/// others: their normals are not steady. Sorted by vertex; ties go to the first event. Empty although there are events:
/// none of them tells a way out, and the edit has to be truncated.
///
/// A rigid body has six degrees of freedom, and what its other vertices do after the first contact follows from that
/// contact: of the events of a pair of bodies of which one is rigid only those of nearly the earliest time count, and
/// at most 32 regions, evenly taken. (mathematics.md, "Rigid bodies")
/// @param start, end the step, (N, 3) each
std::vector<Region> earliest_regions(const Surface& surface, const Events& events, const Positions& start,
                                     const Positions& end);

/// The same events, but all of them, each in the region of its first side alone; those of rigid bodies as above. For
/// deformations in which each contact can be answered by itself. Not in the order of vertices.
std::vector<Region> contact_regions(const Surface& surface, const Events& events, const Positions& start,
                                    const Positions& end);

}  // namespace stiv
