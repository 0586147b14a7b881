// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/detection/event.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// One side of an event: its corners [begin, end), and the displacement of its contact point.
struct ContactSide {
  int begin = 0, end = 0;
  Vector3 displacement = Vector3::Zero();  ///< Dr = sum |w_k| Dq_k over the corners
};

/// A vector for each of an event's four vertices, in their order.
using CornerGradients = std::array<Vector3, 4>;

/// Gradient of (1 - t) n . Dr with respect to the four end positions, with constant t, n and w: (1 - t) |w_k| n at the
/// side's corners.
/// @param normal the event's, oriented so that n . Dr < 0
CornerGradients frozen_gradient(const Event& event, const ContactSide& side, const Vector3& normal);

/// The whole gradient: t, n and w_k depend on all four end positions. [Appendix A] At the time of contact, the vertex
/// and the plane of the face, or the lines of both edges, are at the event's distance. If the normal has no derivative
/// (no area, parallel edges), n and w are constant; if the two sides do not approach, t is.
/// @param start, end the step, (N, 3) each
CornerGradients whole_gradient(const Event& event, const ContactSide& side, const Vector3& normal,
                               const Positions& start, const Positions& end);

}  // namespace stiv
