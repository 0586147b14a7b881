// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/edit_call.hpp"

namespace stiv {

/// The controls closest to `ahead` in the call's metric that respect the contacts on the way to them, and the call's
/// limits: a step of sequential quadratic programming. Surface and contacts are linearised at the accepted state. If
/// contacts balance the way to `ahead`, the result is therefore the accepted controls. It is not tested, and curved
/// surfaces may intersect there. (mathematics.md, "Tight edits")
/// @throws Interrupted
Controls linearised_step(EditCall& call, const Controls& ahead);

}  // namespace stiv
