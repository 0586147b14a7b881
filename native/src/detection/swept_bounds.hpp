// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "detection/candidates.hpp"

namespace stiv {

/// Boxes of all primitives over a step, and which of them the step moves.
struct SweptBounds {
  std::vector<Bounds> vertices, edges, faces;
  std::vector<unsigned char> vertex_moves, edge_moves, face_moves;
};

/// Boxes are taken in a frame centred on the scene that moves with its mean displacement, and padded so that pairs that
/// come within the separation, by whatever the narrow phase may err, overlap.
void sweep_bounds(const Surface& surface, const Step& step, const Execution& execution, SweptBounds& swept);

}  // namespace stiv
