// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "editing/edit_context.hpp"

namespace stiv {

using StatePredicate = std::function<bool(const State&)>;

/// What the rounds of one sub-edit came to.
struct RoundOutcome {
  State candidate;       ///< controls as stored, and their surface
  bool clear = false;    ///< the step from the accepted state to the candidate was detected to be without events
  bool too_far = false;  ///< the step to the candidate was too far to be looked at: no round took place
  PairLimit pair_limit = PairLimit::respected;  ///< of the searches of these rounds
  bool given_up = false;                        ///< `is_diverging` was true
  Events events;                                ///< of the last round that had any
  Index patches = 0;
};

/// Rounds of detection and response from the goal on, until the step from the accepted state is without events: first
/// with all constraints kept and projecting from the goal again, one a patch at first and one a contact where few are
/// left (or from the start, where the metric is local), then Algorithm 1 from where that came to; or that alone, see
/// Projection.
/// Cached candidates, those of earlier edits too, are searched first, and all pairs only if no cached pair interferes:
/// so a few whole searches serve many rounds, and the last search covers all pairs. Candidates
/// are rounded as they will be stored *before* they are looked at, so that the round without events is itself the check
/// of the path of the state to be accepted. [P3.2, Algorithm 1; mathematics.md, "The loop"]
/// `is_diverging`, if given, is asked of some candidates; where it is true the rounds end.
RoundOutcome run_rounds(Problem& problem, const State& accepted, const Controls& goal, Projection projection,
                        PairLimit pair_limit, const StatePredicate& is_diverging, Execution& execution);

/// The same toward `part` of the way to the goal: of twice the part given, or of half, a quarter and so on of that, the
/// farthest that detection can look at in bounded time and memory, so that no motion, however far, exceeds them.
RoundOutcome run_rounds_within_reach(Problem& problem, const State& accepted, const Controls& goal,
                                     Projection projection, double& part, const StatePredicate& is_diverging,
                                     Execution& execution);

/// Did a call that the time budget ended begin these rounds?
bool has_begun_rounds(Problem& problem, const State& accepted, const Controls& goal, Projection projection);

}  // namespace stiv
