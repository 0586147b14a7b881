// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/piercing.hpp"

#include <doctest/doctest.h>

#include <random>

#include "acceptance/integer_geometry.hpp"

using namespace stiv;

namespace {

std::optional<Piercing> pierced(const Segment& segment, const Triangle& triangle, int perturbation = 1) {
  bool touching = false;
  return piercing(segment, triangle, perturbation, touching);
}

}  // namespace

TEST_CASE("a segment through a point of a triangle: position and direction of the crossing") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> part(0.05, 0.95);
  const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
  int through = 0;
  for (const double scale : {1e-7, 1.0, 1e7})
    for (int round = 0; round < 500; ++round) {
      const Triangle t{scale * vector(), scale * vector(), scale * vector()};
      const double at = part(random), second = 1.5 * part(random) - 0.25, third = 1.5 * part(random) - 0.25;
      const Vector3 point = t[0] + second * (t[1] - t[0]) + third * (t[2] - t[0]), way = scale * vector();
      const auto found = pierced({point - at * way, point + (1 - at) * way}, t);
      const bool inside = std::min({second, third, 1 - second - third}) > 0;
      REQUIRE(found.has_value() == inside);
      if (!found) continue;
      CHECK(found->at == doctest::Approx(at).epsilon(1e-9));
      CHECK((found->weights - Eigen::Vector2d(second, third)).norm() < 1e-9);
      CHECK(found->step == ((t[1] - t[0]).cross(t[2] - t[0]).dot(way) < 0 ? 1 : -1));
      ++through;
    }
  CHECK(through > 300);
}

TEST_CASE("a segment that ends on a triangle crosses it or not, by its perturbation") {
  const Triangle t{Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(0, 4, 0)};
  const Segment above{Vector3(1, 1, 2), Vector3(1, 1, 0)};
  bool touching = false;
  CHECK_FALSE(piercing(above, t, 1, touching));
  CHECK(touching);
  const auto through = pierced(above, t, -1);
  REQUIRE(through);
  CHECK(through->step == 1);
  CHECK(through->at == 1);
  touching = false;
  CHECK(piercing({Vector3(1, 1, 2), Vector3(1, 1, -2)}, t, 1, touching));
  CHECK_FALSE(touching);
}

TEST_CASE("a segment crosses a shared edge of two triangles once, and a triangle without area never") {
  const Triangle left{Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(0, 4, 0)};
  const Triangle right{Vector3(4, 0, 0), Vector3(4, 4, 0), Vector3(0, 4, 0)};
  const Triangle line{Vector3(0, 4, 0), Vector3(2, 2, 0), Vector3(4, 0, 0)};
  const Segment segment{Vector3(2, 2, 1), Vector3(2, 2, -1)};
  for (const int perturbation : {1, -1}) {
    CHECK(pierced(segment, left, perturbation).has_value() != pierced(segment, right, perturbation).has_value());
    CHECK_FALSE(pierced(segment, line, perturbation));
  }
}

namespace {

Vector3 real(const IntegerPoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// In units so small that the perturbation, an integer along each axis, cannot change a nonzero sign.
IntegerPoint fine(const IntegerPoint& p, int perturbation) {
  IntegerPoint moved;
  for (std::size_t axis = 0; axis < 3; ++axis)
    moved[axis] = (p[axis] << 31) + perturbation * (std::int64_t{1} << (20 - 10 * axis));
  return moved;
}

}  // namespace

TEST_CASE("perturbed signs equal those of integer coordinates with a slight translation") {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int64_t> coordinate(-4, 4);
  int touching = 0, without_sign = 0;
  for (int round = 0; round < 40000; ++round) {
    const auto point = [&] { return IntegerPoint{coordinate(random), coordinate(random), coordinate(random)}; };
    const IntegerPoint a = point(), b = point(), c = point(), d = point();
    const int perturbation = round % 2 == 0 ? 1 : -1;
    const PerturbedSign side = perturbed_side({real(a), real(b), real(c)}, real(d), perturbation);
    REQUIRE(side.value == integer_orientation_3d(fine(a, 0), fine(b, 0), fine(c, 0), fine(d, perturbation)));
    REQUIRE(side.touching == (integer_orientation_3d(a, b, c, d) == 0));
    const PerturbedSign turn = perturbed_turn({real(a), real(b)}, {real(c), real(d)}, perturbation);
    REQUIRE(turn.value == integer_orientation_3d(fine(a, 0), fine(b, 0), fine(c, perturbation), fine(d, perturbation)));
    touching += side.touching;
    without_sign += side.value == 0;
  }
  CHECK(touching > 1000);
  CHECK(without_sign > 10);  // triangles without area
}
