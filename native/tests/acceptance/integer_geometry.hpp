// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace stiv {

using IntegerPoint = std::array<std::int64_t, 3>;
__extension__ using Wide = __int128;

inline int sign_of_wide(Wide value) { return (value > 0) - (value < 0); }

/// Orientation predicates in 128-bit integers: exact for coordinates below 2^40.
inline int integer_orientation_2d(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c, int drop) {
  const auto x = static_cast<std::size_t>((drop + 1) % 3), y = static_cast<std::size_t>((drop + 2) % 3);
  return sign_of_wide(Wide(b[x] - a[x]) * (c[y] - a[y]) - Wide(b[y] - a[y]) * (c[x] - a[x]));
}

inline int integer_orientation_3d(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c,
                                  const IntegerPoint& d) {
  const auto minor = [&](std::size_t x, std::size_t y) {
    return Wide(b[x] - a[x]) * (c[y] - a[y]) - Wide(b[y] - a[y]) * (c[x] - a[x]);
  };
  const Wide height = minor(1, 2) * (d[0] - a[0]) + minor(2, 0) * (d[1] - a[1]) + minor(0, 1) * (d[2] - a[2]);
  return -sign_of_wide(height);
}

}  // namespace stiv
