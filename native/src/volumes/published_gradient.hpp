// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/detection/event.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// One side of an event: its corners [begin, end), and how its contact point moves.
struct ContactSide {
  int begin = 0, end = 0;
  Vector3 displacement = Vector3::Zero();  ///< Dr = sum |w_k| Dq_k over the corners
};

/// A vector for each of an event's four vertices, in their order.
using CornerGradients = std::array<Vector3, 4>;

/// Gradient of (1 - t) n . Dr by the four end positions, with t, n and w held: (1 - t) |w_k| n at the side's corners.
/// @param normal the event's, turned so that n . Dr < 0
CornerGradients frozen_gradient(const Event& event, const ContactSide& side, const Vector3& normal);

/// The whole gradient of the same: t, n and w_k change with the end positions too, also with those of the other side.
/// [Appendix A] The contact is where the plane of the face and the vertex, or the lines of both edges, are at the
/// event's distance. Where the normal has no derivative (no area, parallel edges), n and w are held; where the two
/// sides do not approach each other, t is.
/// @param start, end the step, (N, 3) each
CornerGradients whole_gradient(const Event& event, const ContactSide& side, const Vector3& normal,
                               const Positions& start, const Positions& end);

}  // namespace stiv
