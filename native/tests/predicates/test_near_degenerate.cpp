// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "acceptance/intersection/expansion_arithmetic.hpp"
#include "acceptance/intersection/predicates.hpp"
#include "predicates/wide_integer.hpp"
#include "stiv/coordinate_range.hpp"

using namespace stiv;

namespace {

constexpr int cases = STIV_PREDICATE_CASES;
constexpr int least_exponent = -232, greatest_exponent = 232;  // of powers of two in the range of coordinates

using Random = std::mt19937_64;
using Points = std::array<Vector3, 4>;
using WidePoint = std::array<WideInteger, 3>;

int random_integer(Random& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
}

/// In [-1, 1), 53 bits.
double random_number(Random& random) { return std::ldexp(static_cast<double>(random() >> 11), -52) - 1; }

Vector3 random_point(Random& random) {
  const double x = random_number(random), y = random_number(random);
  return {x, y, random_number(random)};
}

/// A coordinate moved by some units in its last place.
double nudged(double x, int units) {
  for (; units > 0; --units) x = std::nextafter(x, 8);
  for (; units < 0; ++units) x = std::nextafter(x, -8);
  return x;
}

/// On a grid of 2^-20, the last point exactly in the plane of the others or one unit of 2^-48 off it.
Points on_grid(Random& random) {
  Points p;
  for (int k = 0; k < 3; ++k)
    p[static_cast<std::size_t>(k)] = (random_point(random) * 0x1p20).array().round() * 0x1p-20;
  const int i = random_integer(random, -3, 3), j = random_integer(random, -3, 3);
  p[3] = p[0] + i * (p[1] - p[0]) + j * (p[2] - p[0]);
  p[3][random_integer(random, 0, 2)] += random_integer(random, -1, 1) * 0x1p-48;
  return p;
}

/// The last point in the plane of the others up to rounding, moved by up to two units in the last place.
Points rounded_into_plane(Random& random) {
  Points p{random_point(random), random_point(random), random_point(random), {}};
  const double s = random_number(random), t = random_number(random);
  p[3] = p[0] + s * (p[1] - p[0]) + t * (p[2] - p[0]);
  for (double& coordinate : p[3]) coordinate = nudged(coordinate, random_integer(random, -2, 2));
  return p;
}

/// Axes of very different scale: up to 2^60 between them.
Points of_mixed_scale(Random& random) {
  Points p = rounded_into_plane(random);
  const Vector3 scale(std::ldexp(1.0, -random_integer(random, 0, 30)), 1,
                      std::ldexp(1.0, random_integer(random, 0, 30)));
  for (Vector3& point : p) point = point.cwiseProduct(scale);
  return p;
}

/// All near one line, some coordinates equal, differences that are not representable.
Points near_line(Random& random) {
  const Vector3 a = random_point(random), b = random_point(random);
  Points p{a, b, {}, {}};
  for (int k = 2; k < 4; ++k) {
    p[static_cast<std::size_t>(k)] = a + random_number(random) * (b - a);
    for (double& x : p[static_cast<std::size_t>(k)]) x = nudged(x, random_integer(random, -1, 1));
  }
  if (random_integer(random, 0, 3) == 0) p[1] = a + std::ldexp(1.0, -random_integer(random, 20, 52)) * (b - a);
  if (random_integer(random, 0, 3) == 0) p[3][random_integer(random, 0, 2)] = 0;
  return p;
}

Points near_degenerate(int sort, Random& random) {
  if (sort == 0) return on_grid(random);
  if (sort == 1) return rounded_into_plane(random);
  if (sort == 2) return of_mixed_scale(random);
  return near_line(random);
}

/// The least and largest exponents of all coordinates, as in frexp.
std::pair<int, int> exponents_of(const Points& points) {
  int low = 4000, high = -4000;
  for (const Vector3& point : points)
    for (const double x : point) {
      if (x == 0) continue;
      int exponent = 0;
      std::frexp(x, &exponent);
      low = std::min(low, exponent);
      high = std::max(high, exponent);
    }
  return {low, high};
}

/// Scaled by a power of two, without rounding: anywhere in the range of coordinates, including its ends.
void scale_within_range(Points& points, Random& random) {
  const auto [low, high] = exponents_of(points);
  const int least = least_exponent + 1 - low, most = greatest_exponent - high;
  const int where = random_integer(random, 0, 3);
  const int exponent = where == 0 ? least : where == 1 ? most : random_integer(random, least, most);
  for (Vector3& point : points)
    for (double& x : point) x = std::ldexp(x, exponent);
}

std::array<WidePoint, 4> widened(const Points& points) {
  const int unit = exponents_of(points).first - 53;
  std::array<WidePoint, 4> wide;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) wide[k][axis] = WideInteger(points[k][static_cast<Index>(axis)], unit);
  return wide;
}

WideInteger minor(const WidePoint& a, const WidePoint& b, std::size_t x, std::size_t y) {
  return a[x] * b[y] - a[y] * b[x];
}

WidePoint difference(const WidePoint& a, const WidePoint& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

int exact_orientation(const std::array<WidePoint, 4>& p) {
  const WidePoint a = difference(p[0], p[3]), b = difference(p[1], p[3]), c = difference(p[2], p[3]);
  return (a[0] * minor(b, c, 1, 2) + a[1] * minor(b, c, 2, 0) + a[2] * minor(b, c, 0, 1)).sign();
}

int exact_turn(const WidePoint& a, const WidePoint& b, const WidePoint& c, const WidePoint& d, int drop) {
  const auto x = static_cast<std::size_t>((drop + 1) % 3), y = static_cast<std::size_t>((drop + 2) % 3);
  return minor(difference(b, a), difference(d, c), x, y).sign();
}

}  // namespace

TEST_CASE("near-degenerate: a product and its error are exact, also at the ends of the range") {
  Random random(7);
  int wrong = 0;
  for (int k = 0; k < cases / 10; ++k) {
    const int exponent = random_integer(random, 3 * least_exponent, 3 * greatest_exponent);
    const int other = random_integer(random, least_exponent, greatest_exponent);
    const double x = std::ldexp(random_number(random), std::clamp(exponent, -700, 700));
    const double y = std::ldexp(random_number(random), std::clamp(other, -200, 200));
    const Rounded product = two_product(x, y);
    const int unit = std::ilogb(x) + std::ilogb(y) - 104;  // of the last bit of the exact product
    const WideInteger exact = WideInteger(x, std::ilogb(x) - 52) * WideInteger(y, std::ilogb(y) - 52);
    wrong += (exact - WideInteger(product.high, unit) - WideInteger(product.low, unit)).sign() != 0;
  }
  CHECK(wrong == 0);
}

TEST_CASE("near-degenerate: every sign is that of integer arithmetic") {
  Random random(1);
  int wrong_3d = 0, wrong_2d = 0, wrong_turns = 0, zeros = 0, out_of_range = 0;
  for (int k = 0; k < cases; ++k) {
    Points p = near_degenerate(k % 4, random);
    scale_within_range(p, random);
    for (const Vector3& point : p)
      for (const double x : point) out_of_range += !is_valid_coordinate(x);
    const std::array<WidePoint, 4> wide = widened(p);
    const int expected = exact_orientation(wide), drop = random_integer(random, 0, 2);
    zeros += expected == 0;
    wrong_3d += orientation_3d(p[0], p[1], p[2], p[3]) != expected;
    wrong_3d += orientation_3d(p[3], p[1], p[2], p[0]) != -expected;
    wrong_2d += orientation_2d(p[0], p[1], p[2], drop) != exact_turn(wide[2], wide[0], wide[2], wide[1], drop);
    wrong_turns += turn_2d(p[0], p[1], p[2], p[3], drop) != exact_turn(wide[0], wide[1], wide[2], wide[3], drop);
  }
  CHECK(wrong_3d == 0);
  CHECK(wrong_2d == 0);
  CHECK(wrong_turns == 0);
  CHECK(out_of_range == 0);
  CHECK(zeros > cases / 50);
}
