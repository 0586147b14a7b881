// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/edit_context.hpp"

namespace stiv {

/// Where an edit wants to get to.
struct Aim {
  Controls controls;  ///< the goal of this solve
  Positions surface;  ///< the surface against which the energy counts: that of the final goal
  bool must_improve;  ///< accept only what lowers the energy
};

/// What happened on the way, summed over the solves of one call.
struct SolveReport {
  bool blocked = false;  ///< the last solve ended before the response settled
  double fraction = 1;   ///< least fraction of a step that was accepted
  Events events;         ///< of the last round that had any
  Index patches = 0;
  std::vector<Controls> path;  ///< accepted controls, in order
};

/// The loop of an edit: sub-edits of rounds and acceptance, until the response settles or nothing is gained. `accepted`
/// changes at each acceptance and only then, so it is valid even when Interrupted is thrown. (mathematics.md,
/// "The loop and its guarantee")
void solve(Problem& problem, State& accepted, const Aim& aim, SolveReport& report, Execution& execution);

/// The same toward a goal that may lie many turns away: rotations are cut into steps of at most 0.3 rad, because
/// vertices move on straight lines within a step.
void solve_in_turns(Problem& problem, State& accepted, const Aim& aim, SolveReport& report, Execution& execution);

}  // namespace stiv
