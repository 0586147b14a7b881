// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detection/broad_phase/candidates.hpp"

namespace stiv {

/// The mean displacement of a step if what is left of the displacements without it is much smaller, else zero: seen
/// from a frame that moves along, a common motion sweeps little; seen from one at rest, what rests stays what it was.
/// Any frame is sound, so about a thousand vertices, evenly picked, speak for all. Depends on the step alone, to the
/// last bit. Zero without vertices.
Vector3 common_motion(const PositionsView& start, const PositionsView& end);

}  // namespace stiv
