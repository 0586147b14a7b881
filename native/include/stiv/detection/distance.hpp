// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/detection/event.hpp"

namespace stiv {

/// Closest points of two primitives: signed weights as in Event, and the separation vector sum_k w_k x_k.
template <class Scalar>
struct WitnessOf {
  std::array<Scalar, 4> weights{};
  Eigen::Matrix<Scalar, 3, 1> separation = Eigen::Matrix<Scalar, 3, 1>::Zero();
  Scalar distance = 0;
};
using Witness = WitnessOf<double>;

/// Four points in doubles, or in double-doubles where the narrow phase needs more precision.
template <class Scalar>
using Quadruple = std::array<Eigen::Matrix<Scalar, 3, 1>, 4>;

/// Closest points of point x0 and triangle (x1, x2, x3), clamped; degenerate triangles are segments or points.
/// Source: Ericson, Real-Time Collision Detection, 2005, 5.1.5.
template <class Scalar>
WitnessOf<Scalar> point_triangle(const Quadruple<Scalar>& x);

/// Closest points of segments (x0, x1) and (x2, x3), clamped; parallel and zero-length segments included.
template <class Scalar>
WitnessOf<Scalar> segment_segment(const Quadruple<Scalar>& x);

template <class Scalar>
WitnessOf<Scalar> witness(EventKind kind, const Quadruple<Scalar>& x) {
  return kind == EventKind::vertex_face ? point_triangle<Scalar>(x) : segment_segment<Scalar>(x);
}

}  // namespace stiv
