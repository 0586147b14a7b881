// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/edit_call.hpp"

namespace stiv {

/// The outer loop of an edit: sub-edits, each of rounds and an acceptance, until the response settles or the energy no
/// longer falls. (mathematics.md, "The loop and its guarantee")
void run_sub_edits(EditCall& call, const Aim& aim);

/// The same in steps of at most 0.3 rad, and of at most the longest steps of scalars, because vertices move on straight
/// lines within a step. (mathematics.md, "Rotation steps")
void run_sub_edits_by_steps(EditCall& call, const Aim& aim);

/// Does the goal move controls along pinned axes? The obstacles they hit must move aside, which may raise the energy.
bool moves_pinned_controls(const EditOptions& options, const Controls& from, const Controls& to);

}  // namespace stiv
