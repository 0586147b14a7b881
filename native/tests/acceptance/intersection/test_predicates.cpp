// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>

#include "acceptance/integer_geometry.hpp"
#include "acceptance/intersection/predicates.hpp"

using namespace stiv;

namespace {

Vector3 scaled(const IntegerPoint& point, double scale) {
  return scale * Vector3(static_cast<double>(point[0]), static_cast<double>(point[1]), static_cast<double>(point[2]));
}

/// d in the plane of the others, or one unit off it: d = a + i (b - a) + j (c - a) + off.
IntegerPoint near_plane(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c, std::mt19937& random) {
  std::uniform_int_distribution<int> factor(-3, 3), off(-1, 1);
  const int i = factor(random), j = factor(random);
  IntegerPoint d;
  for (std::size_t k = 0; k < 3; ++k) d[k] = a[k] + i * (b[k] - a[k]) + j * (c[k] - a[k]) + off(random) * off(random);
  return d;
}

}  // namespace

TEST_CASE("predicates: the orientation of a tetrahedron has the documented sign") {
  const Vector3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  CHECK(orientation_3d(a, b, c, {0.2, 0.2, -1}) == 1);
  CHECK(orientation_3d(a, b, c, {0.2, 0.2, 1}) == -1);
  CHECK(orientation_3d(a, b, c, {5, -7, 0}) == 0);
  CHECK(orientation_2d(a, b, c, 2) == 1);
  CHECK(orientation_2d(a, c, b, 2) == -1);
  CHECK(orientation_2d(a, b, c, 0) == 0);
}

TEST_CASE("predicates: signs equal those of integer determinants, at any scale") {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int64_t> coordinate(-(1 << 25), 1 << 25);
  int zeros = 0, wrong = 0;
  for (int round = 0; round < 20000; ++round) {
    const auto point = [&] { return IntegerPoint{coordinate(random), coordinate(random), coordinate(random)}; };
    const IntegerPoint a = point(), b = point(), c = point(), d = near_plane(a, b, c, random);
    const double scale = std::ldexp(1.0, static_cast<int>(random() % 80) - 40);
    const int expected = integer_orientation_3d(a, b, c, d);
    zeros += expected == 0;
    wrong += orientation_3d(scaled(a, scale), scaled(b, scale), scaled(c, scale), scaled(d, scale)) != expected;
    wrong += orientation_3d(scaled(b, scale), scaled(a, scale), scaled(c, scale), scaled(d, scale)) != -expected;
    for (int drop = 0; drop < 3; ++drop)
      wrong += orientation_2d(scaled(a, scale), scaled(b, scale), scaled(d, scale), drop) !=
               integer_orientation_2d(a, b, d, drop);
  }
  CHECK(wrong == 0);
  CHECK(zeros > 3000);
}

TEST_CASE("predicates: exact where coordinate differences are not representable") {
  // Plane through (0,0,0), (1,0,1), (0,1,1): z = x + y, met by a point whose coordinates span 90 bits.
  const double tiny = 0x1p-90;
  const Vector3 a(0, 0, 0), b(1, 0, 1), c(0, 1, 1);
  CHECK(orientation_3d(a, b, c, {1, tiny, 1}) == 1);
  CHECK(orientation_3d(a, b, c, {1, -tiny, 1}) == -1);
  CHECK(orientation_3d(a, b, c, {tiny, -tiny, 0}) == 0);
  CHECK(orientation_3d({1, tiny, 1}, b, c, a) == -orientation_3d(a, b, c, {1, tiny, 1}));
  CHECK(orientation_2d({-tiny, 0, 0}, {1, 1, 0}, {2, 2, 0}, 2) == 1);
  CHECK(orientation_2d({tiny, 0, 0}, {1, 1, 0}, {2, 2, 0}, 2) == -1);
}

TEST_CASE("predicates: consistent along a line in units of the last place") {
  // Shewchuk's figure: points on a grid of one unit in the last place around (0.5, 0.5) against a line through 12, 24.
  const double unit = 0x1p-53;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Vector3 point(0.5 + i * unit, 0.5 + j * unit, 0);
      const int expected = (i < j) - (i > j);
      REQUIRE(orientation_2d(point, {12, 12, 0}, {24, 24, 0}, 2) == expected);
    }
  }
}
