// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>

#include "detection/narrow_phase/near_miss.hpp"
#include "stiv/detection/narrow_phase.hpp"

using namespace stiv;

namespace {

/// A vertex that falls past the edge x = 0 at a distance, beyond it if that is positive. The edge belongs to a face on
/// its other side, or the vertex to an edge on its own side. The edge stretches, and the whole is distorted.
PairMotion passage(EventKind kind, double distance, double stretch, const Eigen::Matrix3d& distortion) {
  const Vector3 vertex(distance, 0, 1), fall(0, 0, -2), first(0, -1, 0), second(0, 1, 0);
  PairMotion motion;
  if (kind == EventKind::vertex_face) {
    motion.start = {vertex, first, second, Vector3(-1, 0, 0)};
    motion.end = {vertex + fall, stretch * first, stretch * second, Vector3(-2, 0, 0)};
  } else {
    motion.start = {vertex, Vector3(1, 1, 1), first, second};
    motion.end = {vertex + fall, Vector3(1, 1, 1) + fall, stretch * first, stretch * second};
  }
  for (auto* points : {&motion.start, &motion.end})
    for (Vector3& point : *points) point = distortion * point;
  return motion;
}

/// Small integers, so that all coordinates stay exact.
Eigen::Matrix3d random_distortion(std::mt19937& random) {
  std::uniform_int_distribution<int> entry(-1, 1);
  Eigen::Matrix3d matrix;
  do
    for (double& value : matrix.reshaped()) value = entry(random);
  while (std::abs(matrix.determinant()) < 0.5);
  return matrix;
}

bool slips(EventKind kind, const PairMotion& motion) {
  const auto approach = advance<double>(RelativeMotion<double>(kind, motion), 0, 0, 1);
  REQUIRE(approach);
  return slips_past(RelativeMotion<DoubleDouble>(kind, motion), 0, *approach);
}

}  // namespace

TEST_CASE("near miss: a vertex slips past an edge if and only if it is beyond it, by however little") {
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial)
    for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge}) {
      const Eigen::Matrix3d distortion = random_distortion(random);
      const double stretch = trial % 3 + 1, distance = 0x1p-49 * (trial % 4 + 1);
      const PairMotion beyond = passage(kind, distance, stretch, distortion);
      CHECK(slips(kind, beyond));
      CHECK(!first_contact(kind, beyond, {}));
      for (const double onto : {0.0, -distance}) {
        const PairMotion meeting = passage(kind, onto, stretch, distortion);
        CHECK(!slips(kind, meeting));
        CHECK(first_contact(kind, meeting, {}));
      }
    }
}
