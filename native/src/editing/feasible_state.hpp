// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "editing/edit_context.hpp"

namespace stiv {

/// The state at controls; nothing, counted as infeasible, if the deformation has no surface there.
std::optional<State> feasible_state(const EditContext& context, const Controls& controls, Execution& execution);

/// The state at controls `to`, or, if the deformation has no surface there, the last one before it on the straight line
/// from a state that has one: to 1/256 of the line.
State last_feasible(const EditContext& context, const State& from, const Controls& to, Execution& execution);

}  // namespace stiv
