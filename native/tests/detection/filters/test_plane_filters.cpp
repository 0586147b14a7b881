// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>

#include "detection/batches.hpp"
#include "detection/reference.hpp"
#include "detection/scenes.hpp"
#include "stiv/detection/detector.hpp"
#include "vector_targets.hpp"

using namespace stiv;

namespace {

const EventKind kinds[] = {EventKind::vertex_face, EventKind::edge_edge};

/// The same motions with all coordinates `scale` times as large.
Batch scaled(const Batch& batch, double scale) {
  std::vector<PairMotion> motions = batch.motions;
  for (PairMotion& motion : motions)
    for (std::size_t k = 0; k < 4; ++k) {
      motion.start[k] *= scale;
      motion.end[k] *= scale;
    }
  return Batch(motions);
}

/// Motions of the pair as a whole: all four vertices move by the same power of two, so nothing is rounded.
Batch carried(MotionMaker& make, std::size_t count) {
  std::vector<PairMotion> motions;
  for (std::size_t k = 0; k < count; ++k) {
    PairMotion motion = make.make(MotionMaker::general);
    for (std::size_t v = 0; v < 4; ++v) {
      motion.start[v] = (0x1p20 * motion.start[v]).array().round() * 0x1p-20;
      motion.end[v] = motion.start[v] + Vector3(0.5, -0.25, 1);
    }
    motions.push_back(motion);
  }
  return Batch(motions);
}

double distance_at_start(EventKind kind, const PairMotion& motion) {
  return static_cast<double>(reference::distance(kind, reference::at(motion, 0)));
}

/// The gap between the sides along an axis during the whole step, computed from their corners.
double gap_along(EventKind kind, const PairMotion& motion, Index axis) {
  const std::size_t others = kind == EventKind::vertex_face ? 1 : 2;
  double beyond = never, before = never;
  for (const auto* positions : {&motion.start, &motion.end})
    for (std::size_t a = 0; a < others; ++a)
      for (std::size_t b = others; b < 4; ++b) {
        const double difference = (*positions)[a][axis] - (*positions)[b][axis];
        beyond = std::min(beyond, difference);
        before = std::min(before, -difference);
      }
  return std::max(beyond, before);
}

}  // namespace

TEST_CASE("box filter: what it calls apart keeps the separation, and every vector target says the same") {
  const auto [apart, all] = check_filter(find_apart_by_boxes, 37);
  CHECK(apart > all / 8);
  CHECK(apart < all);
}

TEST_CASE("box filter: it calls apart what a plane across an axis keeps apart, and nothing else") {
  MotionMaker make(41);
  std::size_t apart = 0, near = 0;
  for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge})
    for (const double separation : {0.0, 0.01, 0.2}) {
      const Batch batch = batch_of(make, MotionMaker::general, PairBlock::capacity);
      const auto flags = flagged(find_apart_by_boxes, kind, batch, separation);
      for (std::size_t k = 0; k < PairBlock::capacity; ++k) {
        double gap = -never;
        for (Index axis = 0; axis < 3; ++axis) gap = std::max(gap, gap_along(kind, batch.motions[k], axis));
        if (std::abs(gap - separation) < 1e-12) continue;
        CHECK((flags[k] != 0) == (gap > separation));
        ++(flags[k] != 0 ? apart : near);
      }
    }
  CHECK(apart > 20);
  CHECK(near > 20);
}

TEST_CASE("plane filter: what it calls apart keeps the separation, and every vector target says the same") {
  const auto [apart, all] = check_filter(find_apart_by_planes, 17);
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

TEST_CASE("closest-point filter: what it calls apart keeps the separation, and every vector target says the same") {
  const auto [apart, all] = check_filter(find_apart_by_closest_points, 23);
  CHECK(apart > all / 8);
  CHECK(apart < all);
}

TEST_CASE("closest-point filter: with the normals, it tells the distance of pairs that are carried along") {
  MotionMaker make(29);
  for (const EventKind kind : kinds) {
    const Batch batch = carried(make, PairBlock::capacity);
    for (std::size_t k = 0; k < PairBlock::capacity; ++k) {
      const double distance = distance_at_start(kind, batch.motions[k]);
      const auto by_closest_points = [&](double separation) {
        return flagged(find_apart_by_closest_points, kind, batch, separation)[k];
      };
      const auto by_normals = [&](double separation) {
        return flagged(find_apart_by_planes, kind, batch, separation)[k];
      };
      CHECK(by_closest_points((1 + 1e-9) * distance) == 0);
      // A normal is taken to be as long as the sum of its components.
      CHECK(by_closest_points((1 - 1e-9) * distance) + by_normals(0.57 * distance) > 0);
    }
  }
}

TEST_CASE("closest-point filter: what is so small that squares vanish is not called apart wrongly") {
  MotionMaker make(31);
  for (const double scale : {0x1p-400, 0x1p-500, 0x1p-530, 0x1p-600})
    for (const EventKind kind : kinds) {
      const Batch large = batch_of(make, MotionMaker::general, PairBlock::capacity), batch = scaled(large, scale);
      const auto flags = flagged(find_apart_by_closest_points, kind, batch, 0.3 * scale);
      for (std::size_t k = 0; k < flags.size(); ++k)
        if (flags[k] != 0) CHECK(reference::first_time(kind, large.motions[k], 0.3, 1e-5L).least > 0.3);
    }
}
