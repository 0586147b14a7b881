// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/round_loop.hpp"

namespace stiv {

struct Acceptance {
  State state;
  double fraction = 0;     ///< of the step to the candidate; 0: nothing was accepted, and `state` is empty
  bool truncated = false;  ///< a larger fraction failed a test of path or surface
  bool is_part = false;    ///< a larger fraction exceeds the longest step of a scalar
};

/// The largest fraction s of the step from the accepted state to the candidate whose controls, as stored, pass the
/// continuous test of the path, the exact static test, and `is_agreeable`: s = 1, then 0.9 times the time of the first
/// contact, or half. If the step exceeds the longest step of a scalar, the search starts with the fraction that does
/// not. A candidate that settled and is not agreeable ends the search. (mathematics.md, "The loop")
/// An accepted candidate is moved from the outcome.
Acceptance accept_largest_fraction(EditCall& call, RoundOutcome& outcome, const StatePredicate& is_agreeable);

}  // namespace stiv
