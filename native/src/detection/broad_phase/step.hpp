// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detection/broad_phase/frame_motions.hpp"
#include "stiv/detection/proximity.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// A linear step of a surface, checked. The positions must outlive it.
struct Step {
  PositionsView start;
  PositionsView end;
  Proximity proximity;
  FrameMotions motions{};  ///< of the frames in which boxes are computed
};

}  // namespace stiv
