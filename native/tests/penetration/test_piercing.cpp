// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/piercing.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace stiv;

namespace {

std::optional<Piercing> pierced(const Segment& segment, const Triangle& triangle, int nudge = 1) {
  bool touching = false;
  return piercing(segment, triangle, nudge, touching);
}

}  // namespace

TEST_CASE("a segment through a point of a triangle goes through it there, from the side on which it begins") {
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
      CHECK((found->place - Eigen::Vector2d(second, third)).norm() < 1e-9);
      CHECK(found->step == ((t[1] - t[0]).cross(t[2] - t[0]).dot(way) < 0 ? 1 : -1));
      ++through;
    }
  CHECK(through > 300);
}

TEST_CASE("a segment that ends on a triangle goes through it if it is nudged that way") {
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

TEST_CASE("through an edge that two triangles share a segment goes once, and through one without area never") {
  const Triangle left{Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(0, 4, 0)};
  const Triangle right{Vector3(4, 0, 0), Vector3(4, 4, 0), Vector3(0, 4, 0)};
  const Triangle line{Vector3(0, 4, 0), Vector3(2, 2, 0), Vector3(4, 0, 0)};
  const Segment segment{Vector3(2, 2, 1), Vector3(2, 2, -1)};
  for (const int nudge : {1, -1}) {
    CHECK(pierced(segment, left, nudge).has_value() != pierced(segment, right, nudge).has_value());
    CHECK_FALSE(pierced(segment, line, nudge));
  }
}
