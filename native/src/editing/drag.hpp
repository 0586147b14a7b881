// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>

#include "editing/edit_call.hpp"

namespace stiv {

// A drag applies the increments of its goal, and pulls toward the goal itself. (mathematics.md, "Deep goals")

/// The increments of a drag so far.
struct DragProgress {
  State followed;  ///< the goal whose increments were applied: the last one, unless the time budget ended its call
  /// Largest displacement of a vertex in an increment of a call with a time budget. It adapts so that each call accepts
  /// a step.
  double stride = std::numeric_limits<double>::infinity();
  bool stride_took_several_calls = false;
};

/// Applies the increment from the goal that was followed last, in strides if the call has a time budget.
void follow_goal(EditCall& call, const Aim& aim, DragProgress& drag);

struct PullLimits {
  double distance = std::numeric_limits<double>::infinity();  ///< largest motion of the goal in a pull
  int pulls = 12;                                             ///< the most pulls
  std::int64_t rounds =
      std::numeric_limits<std::int64_t>::max();  ///< no pull begins after this many rounds of the call
};

/// The limits of a drag's pulls: enough of them to retreat the length of the increment, and one more. A mouse that
/// returns from deep inside a wall lifts the shape off the wall, and pulls move it back.
PullLimits pull_limits_of_drag(const EditContext& context, const DragProgress& drag, const Aim& aim);

/// Pulls until the energy no longer falls enough for the rounds that it takes. Each pull is one sub-edit that accepts
/// only a state with lower energy.
void pull_until_settled(EditCall& call, const Aim& aim, const PullLimits& limits);

/// The longest displacement of a vertex between two surfaces.
double longest_displacement(const Positions& from, const Positions& to);

}  // namespace stiv
