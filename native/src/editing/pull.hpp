// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>

#include "editing/sub_edit_loop.hpp"

namespace stiv {

/// How far pulls go on.
struct PullLimits {
  double distance = std::numeric_limits<double>::infinity();       ///< farthest way of a vertex of the goal in a pull
  int pulls = 12;                                                  ///< at most so many
  std::int64_t rounds = std::numeric_limits<std::int64_t>::max();  ///< none begins after so many rounds of the call
};

/// One sub-edit toward `aim` that moves no vertex of the goal farther than `limit`, and accepts only what lowers the
/// energy. (mathematics.md, "Deep goals")
void pull(Problem& problem, State& accepted, const Aim& aim, double limit, SolveReport& report, Execution& execution);

/// Pulls until the energy no longer falls by enough for the rounds that it takes.
void pull_until_settled(Problem& problem, State& accepted, const Aim& aim, const PullLimits& limits,
                        SolveReport& report, Execution& execution);

}  // namespace stiv
