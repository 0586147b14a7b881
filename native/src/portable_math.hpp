// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stiv {

// The C libraries' functions differ in the last bit. These give the same bits on every platform: correctly rounded
// except for about one argument in 2^40. Above 2^25, an angle is first reduced modulo the double next to 2 pi.

double portable_sin(double angle);
double portable_cos(double angle);

/// The angle of (x, y) in [-pi, pi].
double portable_atan2(double y, double x);

}  // namespace stiv
