// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/edit_call.hpp"

namespace stiv {

/// The controls closest to `ahead` in the call's metric that respect the contacts near the accepted state, and the
/// call's limits. Surface and contacts are linearized at the accepted state. If contacts balance the way to `ahead`,
/// these are therefore the accepted controls: a step of sequential quadratic programming. Nothing is tested: the step
/// may have contacts of second order. (mathematics.md, "Tight edits")
/// @throws Interrupted
Controls linearised_step(EditCall& call, const Controls& ahead);

}  // namespace stiv
