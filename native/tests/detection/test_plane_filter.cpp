// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/batches.hpp"
#include "detection/reference.hpp"
#include "detection/scenes.hpp"
#include "stiv/detection/detector.hpp"
#include "vector_targets.hpp"

using namespace stiv;

TEST_CASE("plane filter: what it calls apart keeps the separation, and every vector target says the same") {
  MotionMaker make(17);
  std::size_t apart = 0, all = 0;
  for (int sort = 0; sort < MotionMaker::sort_count; ++sort)
    for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{13}, PairBlock::capacity})
      for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge}) {
        const Batch batch = batch_of(make, sort, count);
        const double separation = 0.05 * make.number(0, 1);
        const auto flags = for_each_vector_target([&] { return flagged(find_apart, kind, batch, separation); });
        for (const auto& other : flags) CHECK(other == flags.front());
        for (std::size_t k = 0; k < count; ++k) {
          all += 1;
          apart += flags.front()[k];
          if (flags.front()[k] == 0) continue;
          CHECK(reference::first_time(kind, batch.motions[k], separation, 1e-5L).least > separation);
        }
      }
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
