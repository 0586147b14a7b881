// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/types.hpp"

namespace stiv {

/// Sign (-1, 0, 1) of the volume of (a, b, c, d), positive when d lies below the plane of a, b, c seen
/// counter-clockwise. Exact for finite doubles without over- or underflow: a filtered evaluation, then expansion
/// arithmetic (Shewchuk 1997).
int orientation_3d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// Sign of the area of (a, b, c) projected along axis `drop` (0, 1, 2). Exact.
int orientation_2d(const Vector3& a, const Vector3& b, const Vector3& c, int drop);

}  // namespace stiv
