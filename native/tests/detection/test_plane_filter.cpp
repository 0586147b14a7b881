// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/motions.hpp"
#include "detection/plane_filter.hpp"
#include "detection/reference.hpp"
#include "detection/scenes.hpp"
#include "stiv/detection/detector.hpp"
#include "vector_targets.hpp"

using namespace stiv;

namespace {

/// Pairs of motions side by side, four vertices each.
struct Batch {
  std::vector<PairMotion> motions;
  Positions start, end;
  PairBlock block;
  VertexSteps vertices;

  Batch(std::vector<PairMotion> of) : motions(std::move(of)) {
    start.resize(static_cast<Index>(4 * motions.size()), 3);
    end = start;
    Index row = 0;
    for (const PairMotion& motion : motions) {
      block.add({row, row + 1, row + 2, row + 3});
      for (std::size_t k = 0; k < 4; ++k, ++row) {
        start.row(row) = motion.start[k];
        end.row(row) = motion.end[k];
      }
    }
    vertices.update(start, end, Execution(1));
  }
};

Batch batch_of(MotionMaker& make, int sort, std::size_t count) {
  std::vector<PairMotion> motions;
  for (std::size_t k = 0; k < count; ++k) motions.push_back(make.make(sort));
  return Batch(std::move(motions));
}

}  // namespace

TEST_CASE("plane filter: what it calls apart keeps the separation, and every vector target says the same") {
  MotionMaker make(17);
  std::size_t apart = 0, all = 0;
  for (int sort = 0; sort < MotionMaker::sort_count; ++sort)
    for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{13}, PairBlock::capacity})
      for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge}) {
        const Batch batch = batch_of(make, sort, count);
        const double separation = 0.05 * make.number(0, 1);
        const auto flags = for_each_vector_target([&] {
          PairFlags found{};
          find_apart(kind, batch.block, batch.vertices, separation, found);
          return std::vector<unsigned char>(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
        });
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
