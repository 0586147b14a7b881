// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <numbers>

#include "stiv/types.hpp"

namespace stiv {

/// The winding number of triangles, (F, 3), around a point not on them: the sum of their solid angles [van Oosterom,
/// Strackee 1983] over 4 pi.
inline double winding_by_solid_angles(const Triangles& triangles, const Positions& q, const Vector3& point) {
  double sum = 0;
  for (const auto& corners : triangles.rowwise()) {
    const Vector3 a = q.row(corners[0]).transpose() - point, b = q.row(corners[1]).transpose() - point,
                  c = q.row(corners[2]).transpose() - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace stiv
