// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "editing/round_loop.hpp"

namespace stiv {

struct Acceptance {
  State state;
  double fraction = 0;  ///< of the step to the candidate; 0: nothing was accepted, and `state` is empty
  bool held = false;    ///< a larger fraction failed a test of path or surface
};

/// The largest fraction s of the step from the accepted state to the candidate whose controls, as stored, pass the
/// continuous check of the path, the exact static test, and `agreeable`: s = 1, then 0.9 times the time of the first
/// contact, or half. A settled candidate that is not agreeable is left at once: there is nothing to gain.
/// (mathematics.md, "The loop")
Acceptance accept_largest(Problem& problem, const State& accepted, const RoundOutcome& outcome,
                          const std::function<bool(const State&)>& agreeable, Execution& execution);

}  // namespace stiv
