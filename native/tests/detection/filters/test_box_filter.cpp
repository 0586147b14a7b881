// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>

#include "detection/batches.hpp"
#include "detection/filters/pair_filters.hpp"

using namespace stiv;

namespace {

/// How far the sides lie apart along an axis for the whole step, by their corners.
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
