// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/solve.hpp"

namespace stiv {

/// One solve toward `aim` that moves no vertex of the goal farther than `limit`, and accepts only what lowers the
/// energy. [DESIGN 4, "Deep goals"]
void pull(Problem& problem, State& accepted, const Aim& aim, double limit, SolveReport& report, Execution& execution);

/// Pulls until the energy no longer falls or the response no longer settles, `most` times at most.
void pull_until_settled(Problem& problem, State& accepted, const Aim& aim, double limit, int most, SolveReport& report,
                        Execution& execution);

}  // namespace stiv
