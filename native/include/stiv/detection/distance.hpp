// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/detection/event.hpp"

namespace stiv {

/// Nearest points of two primitives: signed weights as in Event, and the separation vector sum_k w_k x_k.
struct Witness {
  std::array<double, 4> weights{};
  Vector3 separation = Vector3::Zero();
  double distance = 0;
};

/// Nearest points of point x0 and triangle (x1, x2, x3), clamped; degenerate triangles are segments or points.
/// Source: Ericson, Real-Time Collision Detection, 2005, 5.1.5.
Witness point_triangle(const std::array<Vector3, 4>& x);

/// Nearest points of segments (x0, x1) and (x2, x3), clamped; parallel and zero-length segments included.
Witness segment_segment(const std::array<Vector3, 4>& x);

inline Witness witness(EventKind kind, const std::array<Vector3, 4>& x) {
  return kind == EventKind::vertex_face ? point_triangle(x) : segment_segment(x);
}

}  // namespace stiv
