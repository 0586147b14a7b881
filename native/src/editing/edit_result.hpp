// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/sub_edit_loop.hpp"
#include "stiv/editing/session.hpp"

namespace stiv {

/// Bodies of the events' vertices, ascending, each once.
std::vector<Index> bodies_in_contact(const Surface& surface, const Events& events);

/// The status of a call that ended by itself.
EditStatus status_of(const Problem& problem, const State& before, const State& accepted, const Controls& goal,
                     const SolveReport& report);

/// Everything but counters and timings of an edit's result.
EditResult make_result(const Problem& problem, const State& accepted, const Positions& goal_surface, SolveReport report,
                       EditStatus status);

}  // namespace stiv
