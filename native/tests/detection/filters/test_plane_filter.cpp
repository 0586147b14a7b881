// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/batches.hpp"
#include "detection/scenes.hpp"
#include "stiv/detection/detector.hpp"
#include "vector_targets.hpp"

using namespace stiv;

TEST_CASE("plane filter: what it calls apart keeps the separation, and every vector target says the same") {
  const auto [apart, all] = check_filter(find_apart, 17);
  CHECK(apart > all / 8);
  CHECK(apart < all);
}

TEST_CASE("plane filter: a whole detection gives the same bits with every vector target") {
  const MovingScene scene = stirred_sheets(12, 3, 0.15, 41);
  for (const double separation : {0.0, 0.02}) {
    const auto found = for_each_vector_target([&] {
      Execution execution(2);
      return Detector(scene.surface).find(scene.start, scene.end, {separation, 0.5}, execution);
    });
    REQUIRE(found.front().size() > 50);
    for (const Events& other : found) {
      REQUIRE(other.size() == found.front().size());
      for (std::size_t k = 0; k < other.size(); ++k) {
        CHECK(other[k].vertices == found.front()[k].vertices);
        CHECK(other[k].time == found.front()[k].time);
        CHECK(other[k].weights == found.front()[k].weights);
        CHECK(other[k].normal == found.front()[k].normal);
      }
    }
  }
}
