// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/displaced_bodies.hpp"

#include <doctest/doctest.h>

#include "editing/small_scenes.hpp"

using namespace stiv;

TEST_CASE("a body is displaced if any bit of it changed") {
  const tests::Scene scene = tests::two_sheets();
  const Positions& from = scene.controls;
  Positions to = from;
  CHECK(displaced_bodies(*scene.surface, from, to) == std::vector<unsigned char>{0, 0});
  to(60, 1) = std::nextafter(to(60, 1), 9.0);
  CHECK(displaced_bodies(*scene.surface, from, to) == std::vector<unsigned char>{0, 1});
  to(0, 2) += 1;
  CHECK(displaced_bodies(*scene.surface, from, to) == std::vector<unsigned char>{1, 1});
}
