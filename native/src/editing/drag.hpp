// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "editing/edit_call.hpp"

namespace stiv {

// A drag applies the increments of its goal, and pulls toward the goal itself. (mathematics.md, "Deep goals")

/// The increments of a drag so far.
struct DragProgress {
  State followed;  ///< the goal whose increments were applied: the last one, unless the time budget ended its call
  /// Largest displacement of a vertex in an increment of a call with a time budget. It adapts so that each call accepts
  /// a step.
  double stride = std::numeric_limits<double>::infinity();
  bool stride_took_too_long = false;  ///< several calls, or too long to be shown; and had contacts
  /// Part of a pull that a stride of a call that hands over includes. It adapts so that the call is not late.
  double reach = 1;
  bool is_leaping = false;       ///< the time budget ended a leap, which the next call to the same goal resumes
  double missing_at_detour = 0;  ///< way to the goal when the last detour failed; 0: none did
  double missing_at_leap = 0;    ///< the same at the last leap, if it gained little; else 0
  std::optional<Controls> leapt_from =
      std::nullopt;  ///< accepted controls from which a leap to this goal gains nothing

  void adapt_reach(const EditCall& call) {
    constexpr double least = 1.0 / 64;
    if (!call.hand_over) return;
    if (call.is_late()) reach = std::max(reach / 2, least);
    if (!call.is_to_hand_over()) reach = std::min(2 * reach, 1.0);
  }

  /// Halves the stride after one that went this way at most, but not below the shortest.
  void shorten_stride(double way, double shortest) {
    stride = std::max(std::min(stride, way) / 2, shortest);
    stride_took_too_long = false;
  }
};

/// Applies the increment from the goal that was followed last, in strides if the call has a time budget.
void follow_goal(EditCall& call, const Aim& aim, DragProgress& drag);

struct PullLimits {
  double distance = std::numeric_limits<double>::infinity();  ///< largest motion of the goal in a pull
  int pulls = 12;                                             ///< the most pulls
  int poor_pulls = 1;  ///< consecutive pulls that lower the energy too little, after which no other begins
};

/// Consecutive poor pulls that end a call. One, if a time budget ends most calls after a pull at most.
int poor_pulls_before_end(const Execution& execution);

/// The limits of a drag's pulls: enough of them to retreat the length of the increment, and one more; without a time
/// budget, as many as gain enough. A mouse that returns from deep inside a wall lifts the shape off the wall, and pulls
/// move it back. With a large body, one pull goes as far as all of them together: each would need a search and a test
/// of the whole body.
PullLimits pull_limits_of_drag(const EditContext& context, const DragProgress& drag, const Aim& aim,
                               const Execution& execution);

/// Pulls until the energy no longer falls enough for the rounds that it takes, or not at all. Each pull is one sub-edit
/// that accepts only a state with lower energy. A pull that gains clearly more than the one before is never poor: a
/// shape that slides off an edge starts slowly.
void pull_until_settled(EditCall& call, const Aim& aim, const PullLimits& limits);

/// Pulls toward a far goal without a limit on its motion. Short pulls cannot take a shape around an obstacle that the
/// goal has passed. A leap that fails does not block the call, and is not repeated.
void leap(EditCall& call, const Aim& aim, DragProgress& drag);

/// Pulls, and leaps. A surface that deforms leaps only if its last leap gained clearly, or the way to the goal has
/// grown since. Without a time budget, it leaps first, which leaves less to pull. Leaps turn rigid bodies too far for
/// that.
void pull_and_leap(EditCall& call, const Aim& aim, DragProgress& drag, PullLimits limits);

/// Moves a rigid body that an obstacle keeps far from its goal aside, across the way to it, and lets it leap from
/// there. Ends where it began if no way aside lowers the energy clearly. Returns whether one did. Does nothing near the
/// goal, with a time budget, or unless the controls are those of one rigid body: among several, the others shall be
/// pushed. (mathematics.md, "Deep goals")
bool detour(EditCall& call, const Aim& aim);

/// The same for a drag, which tries a detour again only when the way to the goal has doubled since one failed.
bool detour_of_drag(EditCall& call, const Aim& aim, DragProgress& drag);

}  // namespace stiv
