// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/batches.hpp"
#include "detection/filters/pair_filters.hpp"
#include "detection/reference.hpp"

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

/// Motions that leave the pair as it is: all four vertices go the same way, by a power of two, so that nothing rounds.
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

}  // namespace

TEST_CASE("nearest filter: what it calls apart keeps the separation, and every vector target says the same") {
  const auto [apart, all] = check_filter(find_apart_by_closest_points, 23);
  CHECK(apart > all / 8);
  CHECK(apart < all);
}

TEST_CASE("nearest filter: with the normals, it tells the distance of pairs that are carried along") {
  MotionMaker make(29);
  for (const EventKind kind : kinds) {
    const Batch batch = carried(make, PairBlock::capacity);
    for (std::size_t k = 0; k < PairBlock::capacity; ++k) {
      const double distance = distance_at_start(kind, batch.motions[k]);
      const auto by_rims = [&](double separation) {
        return flagged(find_apart_by_closest_points, kind, batch, separation)[k];
      };
      const auto by_normals = [&](double separation) {
        return flagged(find_apart_by_planes, kind, batch, separation)[k];
      };
      CHECK(by_rims((1 + 1e-9) * distance) == 0);
      // A normal is taken to be as long as the sum of its components.
      CHECK(by_rims((1 - 1e-9) * distance) + by_normals(0.57 * distance) > 0);
    }
  }
}

TEST_CASE("nearest filter: what is so small that squares vanish is not called apart wrongly") {
  MotionMaker make(31);
  for (const double scale : {0x1p-400, 0x1p-500, 0x1p-530, 0x1p-600})
    for (const EventKind kind : kinds) {
      const Batch large = batch_of(make, MotionMaker::general, PairBlock::capacity), batch = scaled(large, scale);
      const auto flags = flagged(find_apart_by_closest_points, kind, batch, 0.3 * scale);
      for (std::size_t k = 0; k < flags.size(); ++k)
        if (flags[k] != 0) CHECK(reference::first_time(kind, large.motions[k], 0.3, 1e-5L).least > 0.3);
    }
}
