// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detection/narrow_phase/conservative_advancement.hpp"

namespace stiv {

/// Completes a contact that a narrow phase found.
Contact contact_of(const RelativeMotion<double>& motion, const Approach<double>& approach, double start_distance);

/// The clearance of the pair by its distance at the reference: `start_distance` if that is the start of the step.
PairClearance pair_clearance(EventKind kind, const PairMotion& motion, const Proximity& proximity,
                             double start_distance);

}  // namespace stiv
