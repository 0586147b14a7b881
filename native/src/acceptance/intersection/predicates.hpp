// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/types.hpp"

namespace stiv {

/// Sign (-1, 0, 1) of the volume of (a, b, c, d), positive when d lies below the plane of a, b, c seen
/// counter-clockwise. Exact for coordinates in the range of coordinate_range.hpp (Surface::check_positions enforces
/// it), rounding to nearest (FloatingPointScope): a filtered evaluation, then expansion arithmetic. Source: Shewchuk,
/// Adaptive precision floating-point arithmetic, 1997.
int orientation_3d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// Sign of the area of (a, b, c) projected along axis `drop` (0, 1, 2), counter-clockwise positive as seen from the end
/// of that axis. Exact likewise.
int orientation_2d(const Vector3& a, const Vector3& b, const Vector3& c, int drop);

/// Sign of the turn from b - a to d - c, projected likewise, less than half a turn counter-clockwise positive. Exact
/// likewise.
int turn_2d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d, int drop);

}  // namespace stiv
