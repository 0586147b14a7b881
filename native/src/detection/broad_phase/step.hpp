// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/detection/proximity.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// A linear step of a surface, checked. The positions must outlive it.
struct Step {
  PositionsView start;
  PositionsView end;
  Proximity proximity;
  Vector3 motion = Vector3::Zero();  ///< of the frame in which boxes are computed, see common_motion
};

/// The mean displacement of a step if the displacements relative to it are much smaller, else zero. A frame that moves
/// along makes the boxes of a common motion small; a frame at rest keeps the boxes of vertices at rest unchanged. Any
/// frame is valid, so the mean of about a thousand evenly picked vertices is enough. Depends only on the step, to the
/// last bit. Zero without vertices.
Vector3 common_motion(const PositionsView& start, const PositionsView& end);

}  // namespace stiv
