// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The barycentric cell of a vertex, with the event it is hit by first. [P4, "Interference prisms"]
struct Region {
  Index vertex = 0;
  Index event = 0;  ///< position in the list of events
};

/// Each event falls into one region on either side, that of its heaviest vertex; a region keeps the earliest event
/// whose normal is usable (n . Drho < -1e-8 |Drho|). Sorted by vertex; ties go to the first event. Empty although there
/// are events: none of them tells a way out, and the edit has to be truncated.
/// @param displacement Dq = end - start, (N, 3)
std::vector<Region> earliest_regions(const Events& events, const Positions& displacement);

}  // namespace stiv
