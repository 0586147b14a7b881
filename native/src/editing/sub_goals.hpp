// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/edit_call.hpp"

namespace stiv {

/// Runs the sub-edits toward points on the way to the goal, a quarter of the diagonal apart, and then toward the goal.
/// A projection from deep inside or beyond an obstacle can leave it on the wrong side; from near its surface it rarely
/// does. Two sub-goals without a gain end them. With a time budget there are no sub-goals, so that settling can resume
/// the rounds. (mathematics.md, "The loop")
void approach_by_sub_goals(EditCall& call, const Aim& aim);

/// Ends the edit at the accepted state of its path with the least energy. A sub-edit can raise the energy, because it
/// aims at a sub-goal or at a rotation step.
void return_to_best(EditCall& call, const Aim& aim);

}  // namespace stiv
