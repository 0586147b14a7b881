// SPDX-License-Identifier: GPL-3.0-or-later
#include "portable_math.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <Eigen/Core>

#include "error_free.hpp"

namespace stiv {

namespace {

// Arithmetic on sums of two doubles, with relative errors of a few 2^-106. [Joldes, Muller, Popescu 2017]

Rounded operator-(Rounded a) { return {-a.high, -a.low}; }

Rounded operator+(Rounded a, Rounded b) {
  const Rounded high = two_sum(a.high, b.high), low = two_sum(a.low, b.low);
  const Rounded sum = fast_two_sum(high.high, high.low + low.high);
  return fast_two_sum(sum.high, sum.low + low.low);
}

Rounded operator-(Rounded a, Rounded b) { return a + -b; }

Rounded operator*(Rounded a, Rounded b) {
  const Rounded product = two_product(a.high, b.high);
  return fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

Rounded operator/(Rounded a, Rounded b) {
  const double first = a.high / b.high;
  const Rounded rest = a - Rounded{first, 0} * b;
  return fast_two_sum(first, rest.high / b.high);
}

Rounded exactly(double x) { return {x, 0}; }

constexpr double half_pi[] = {0x1.921fb54442d18p0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};

/// An angle as a multiple of pi/2, modulo 4, and a rest in [-pi/4, pi/4].
struct Reduced {
  std::int64_t quadrant;
  Rounded rest;
};

Reduced reduced(double angle) {
  if (std::abs(angle) > 0x1p25) angle = std::fmod(angle, 2 * std::numbers::pi);
  const double turns = std::floor(angle / half_pi[0] + 0.5);
  Rounded rest = exactly(angle);
  for (const double part : half_pi) rest = rest - two_product(turns, part);
  return {static_cast<std::int64_t>(turns) & 3, rest};
}

/// 1 - x^2/(k (k-1)) (1 - x^2/((k+2) (k+1)) (1 - ...)): the Taylor series of cos x for k = 2, of sin x / x for k = 3.
Rounded alternating_series(Rounded x, int k) {
  const Rounded square = x * x;
  Rounded sum = exactly(1);
  for (int n = k + 26; n >= k; n -= 2) sum = exactly(1) - square * sum / exactly(n * (n - 1));
  return sum;
}

/// The sine of an angle and a number of right angles.
Rounded sine(double angle, int right_angles) {
  const Reduced of = reduced(angle);
  const std::int64_t quadrant = of.quadrant + right_angles;
  const Rounded value = quadrant % 2 == 0 ? of.rest * alternating_series(of.rest, 3) : alternating_series(of.rest, 2);
  return quadrant % 4 < 2 ? value : -value;
}

/// atan x for |x| < 1/200, by its Taylor series.
Rounded small_arc_tangent(Rounded x) {
  const Rounded square = x * x;
  Rounded sum = exactly(0);
  for (int n = 15; n >= 1; n -= 2) sum = exactly(1) / exactly(n) - square * sum;
  return x * sum;
}

/// The angle of (x, y), to 1/200.
double rough_angle(double y, double x) {
  const double u = std::abs(x), v = std::abs(y), ratio = std::min(u, v) / std::max(u, v);
  const double eighth = ratio * (std::numbers::pi / 4 + 0.273 * (1 - ratio));
  const double quarter = v <= u ? eighth : half_pi[0] - eighth;
  return std::copysign(x < 0 ? std::numbers::pi - quarter : quarter, y);
}

/// Eigen sums the products of large matrices in blocks that fit into the cache. Without this it asks the processor for
/// the sizes, and processors with different caches give different bits.
// NOLINTNEXTLINE(bugprone-throwing-static-initialization): two functions that set numbers
[[maybe_unused]] const bool cache_sizes_are_fixed = [] {
  Eigen::setCpuCacheSizes(48 << 10, 2 << 20, 8 << 20);
  return true;
}();

}  // namespace

double portable_sin(double angle) {
  return std::isfinite(angle) ? sine(angle, 0).high : std::numeric_limits<double>::quiet_NaN();
}

double portable_cos(double angle) {
  return std::isfinite(angle) ? sine(angle, 1).high : std::numeric_limits<double>::quiet_NaN();
}

double portable_atan2(double y, double x) {
  const double largest = std::max(std::abs(x), std::abs(y));
  if (largest == 0) return std::copysign(std::signbit(x) ? std::numbers::pi : 0, y);
  const int exponent = std::ilogb(largest);
  const Rounded across = exactly(std::ldexp(y, -exponent)), along = exactly(std::ldexp(x, -exponent));
  const double angle = rough_angle(across.high, along.high);
  const Rounded s = sine(angle, 0), c = sine(angle, 1);
  const Rounded rest = (across * c - along * s) / (along * c + across * s);
  return (exactly(angle) + small_arc_tangent(rest)).high;
}

}  // namespace stiv
