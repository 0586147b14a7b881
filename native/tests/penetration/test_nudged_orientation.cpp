// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/nudged_orientation.hpp"

#include <doctest/doctest.h>

#include <random>

#include "acceptance/integer_geometry.hpp"

using namespace stiv;

namespace {

Vector3 real(const IntegerPoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// In units so small that the nudge, a whole number of them along each axis, cannot turn a sign that is not zero.
IntegerPoint fine(const IntegerPoint& p, int nudge) {
  IntegerPoint moved;
  for (std::size_t axis = 0; axis < 3; ++axis)
    moved[axis] = (p[axis] << 31) + nudge * (std::int64_t{1} << (20 - 10 * axis));
  return moved;
}

}  // namespace

TEST_CASE("nudged signs are those of integers of which one body is moved by a little") {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int64_t> coordinate(-4, 4);
  int touching = 0, without_sign = 0;
  for (int round = 0; round < 40000; ++round) {
    const auto point = [&] { return IntegerPoint{coordinate(random), coordinate(random), coordinate(random)}; };
    const IntegerPoint a = point(), b = point(), c = point(), d = point();
    const int nudge = round % 2 == 0 ? 1 : -1;
    const NudgedSign side = nudged_side({real(a), real(b), real(c)}, real(d), nudge);
    REQUIRE(side.value == integer_orientation_3d(fine(a, 0), fine(b, 0), fine(c, 0), fine(d, nudge)));
    REQUIRE(side.touching == (integer_orientation_3d(a, b, c, d) == 0));
    const NudgedSign turn = nudged_turn({real(a), real(b)}, {real(c), real(d)}, nudge);
    REQUIRE(turn.value == integer_orientation_3d(fine(a, 0), fine(b, 0), fine(c, nudge), fine(d, nudge)));
    touching += side.touching;
    without_sign += side.value == 0;
  }
  CHECK(touching > 1000);
  CHECK(without_sign > 10);  // triangles without area
}
