// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace stiv {

/// Weights of four points at -1, 0, 1, 2 for the value at t in [0, 1]; they sum to 1.
using FourWeights = std::array<double, 4>;

/// Linear interpolation of the two middle points.
inline FourWeights linear_weights(double t) { return {0, 1 - t, t, 0}; }

/// Uniform cubic B-spline.
inline FourWeights bspline_weights(double t) {
  const double u = 1 - t;
  return {u * u * u / 6, (t * t * (3 * t - 6) + 4) / 6, (t * (t * (3 - 3 * t) + 3) + 1) / 6, t * t * t / 6};
}

/// Cardinal spline: interpolates the middle points; tangents are `tension` times the difference of the neighbors.
inline FourWeights cardinal_weights(double t, double tension) {
  const double c = tension;
  return {-c * t * (t * (t - 2) + 1), t * t * ((2 - c) * t + c - 3) + 1, t * (t * ((c - 2) * t + 3 - 2 * c) + c),
          c * t * t * (t - 1)};
}

}  // namespace stiv
