// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/types.hpp"

namespace stiv {

/// Sign (-1, 0, 1) of the volume of the tetrahedron (a, b, c, d): positive if a, b, c are counter-clockwise seen from
/// above and d is below their plane. Exact for coordinates in the range of coordinate_range.hpp and rounding to nearest
/// (FloatingPointScope): a floating-point filter, then expansion arithmetic. [Shewchuk 1997]
int orientation_3d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// Sign of the area of (a, b, c) projected along axis `drop` (0, 1, 2), positive if counter-clockwise seen from the
/// positive end of the axis. Exact likewise.
int orientation_2d(const Vector3& a, const Vector3& b, const Vector3& c, int drop);

/// Sign of the cross product of b - a and d - c, projected likewise. Exact likewise.
int turn_2d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d, int drop);

}  // namespace stiv
