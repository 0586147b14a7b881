// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/detection/detector.hpp"

namespace stiv {

/// Events of the beginning of a step.
struct EventsUntil {
  Events events;     ///< times are those of the whole step
  double until = 1;  ///< so far the step was looked at, in (0, 1]: nothing is known of what comes after
};

/// The events of as much of a step as brings few enough pairs near each other to be looked at in bounded time and
/// memory: of all of it, or of a half, a quarter, ... (then of start -> start + until (end - start), as rounded). Below
/// 2^-16 it is not the motion that makes the pairs, and they are all looked at.
EventsUntil find_manageable_part(Detector& detector, const Positions& start, const Positions& end, Proximity proximity,
                                 Execution& execution);

}  // namespace stiv
