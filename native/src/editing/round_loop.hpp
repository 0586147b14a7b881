// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/problem.hpp"

namespace stiv {

/// What the rounds of one sub-edit came to.
struct RoundOutcome {
  State candidate;     ///< controls as stored, and their surface
  bool clear = false;  ///< the step from the accepted state to the candidate was detected to be without events
  Events events;       ///< of the last round that had any
  Index patches = 0;
};

/// Rounds of detection and response from the goal on, until the step from the accepted state is without events: first
/// with all constraints kept and projecting from the goal again, one a patch at first and one a contact where few are
/// left (or from the start, where the metric is local), then Algorithm 1 from where that came to.
/// Candidates are rounded as they will be stored *before* they are looked at, so that the round without events is
/// itself the check of the path of the state to be accepted. [P3.2, Algorithm 1; DESIGN 4; mathematics.md, "The loop"]
RoundOutcome run_rounds(Problem& problem, const State& accepted, const Controls& goal, Execution& execution);

}  // namespace stiv
