// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/common_motion.hpp"
#include "detection/scenes.hpp"

using namespace stiv;

namespace {

Vector3 of(const MovingScene& scene, const Positions& end, int threads) {
  return common_motion(scene.start, end, Execution(threads));
}

}  // namespace

TEST_CASE("common motion: the mean where most of the motion is alike, zero else, for any number of threads the same") {
  const MovingScene scene = stirred_sheets(70, 2, 0.001, 1);
  const Vector3 carried(3, -2, 1);
  const Positions all = scene.end.rowwise() + carried.transpose();
  const Vector3 mean = (all - scene.start).colwise().mean();
  CHECK((of(scene, all, 1) - mean).norm() <= 1e-12 * mean.norm());
  CHECK(of(scene, all, 1) == of(scene, all, 3));
  Positions half = all;
  half.topRows(half.rows() / 2) = scene.start.topRows(half.rows() / 2);
  CHECK(of(scene, half, 1) == Vector3::Zero());
  CHECK(of(scene, scene.start, 1) == Vector3::Zero());
}
