// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/edit_call.hpp"
#include "stiv/editing/session.hpp"

namespace stiv {

/// The status of a call that was not interrupted.
EditStatus status_of(const EditContext& context, const Controls& before, const Controls& accepted, const Controls& goal,
                     const EditReport& report);

EditResult make_result(const EditContext& context, const State& accepted, const Positions& goal_surface,
                       EditReport report, EditStatus status, const Execution& execution);

}  // namespace stiv
