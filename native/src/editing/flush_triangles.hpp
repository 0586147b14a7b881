// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/surface.hpp"

namespace stiv {

/// Of the normals of two triangles that lie on each other: small ones are tilted by rounding.
constexpr double least_flush_cosine = 0.9;

using Corners = std::array<Vector3, 3>;

inline Corners corners_of(const Triangles& triangles, Index triangle, const PositionsView& q) {
  Corners corners;
  for (int k = 0; k < 3; ++k) corners[at(k)] = q.row(triangles(triangle, k));
  return corners;
}

/// Twice the area long.
inline Vector3 area_normal_of(const Corners& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

/// Unit, or zero for a triangle without area.
inline Vector3 normal_of(const Corners& corners) { return area_normal_of(corners).normalized(); }

}  // namespace stiv
