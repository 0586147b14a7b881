// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stiv {

/// A rounded result and its rounding error: high + low is exact.
struct Rounded {
  double high;
  double low;
};

/// x + y, for any two magnitudes. [Shewchuk 1997, theorem 7, after Knuth]
inline Rounded two_sum(double x, double y) {
  const double sum = x + y;
  const double of_y = sum - x;
  const double of_x = sum - of_y;
  return {sum, (x - of_x) + (y - of_y)};
}

/// x + y where |x| >= |y| or x is 0. [theorem 6, after Dekker]
inline Rounded fast_two_sum(double x, double y) {
  const double sum = x + y;
  return {sum, y - (sum - x)};
}

/// A double as two of at most 26 bits each. It overflows above 2^996. [theorem 17, after Veltkamp]
inline Rounded split(double x) {
  const double shifted = 0x1.0000002p27 * x, high = shifted - (shifted - x);
  return {high, x - high};
}

/// x * y. Without std::fma, which rounds twice on some platforms. [theorem 18, after Dekker]
inline Rounded two_product(double x, double y) {
  const double product = x * y;
  const Rounded a = split(x), b = split(y);
  return {product, ((a.high * b.high - product) + a.high * b.low + a.low * b.high) + a.low * b.low};
}

}  // namespace stiv
