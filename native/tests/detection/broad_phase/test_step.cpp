// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/broad_phase/step.hpp"
#include "detection/scenes.hpp"

using namespace stiv;

TEST_CASE("common motion: about the mean where most of the motion is alike, zero else") {
  const MovingScene scene = stirred_sheets(70, 2, 0.001, 1);
  const Vector3 carried(3, -2, 1);
  const Positions all = scene.end.rowwise() + carried.transpose();
  const double most = (scene.end - scene.start).rowwise().norm().maxCoeff();
  CHECK((common_motion(scene.start, all) - carried).norm() <= most);
  CHECK(common_motion(scene.start, scene.start.rowwise() + carried.transpose()).isApprox(carried, 1e-12));
  Positions half = all;
  half.topRows(half.rows() / 2) = scene.start.topRows(half.rows() / 2);
  CHECK(common_motion(scene.start, half) == Vector3::Zero());
  CHECK(common_motion(scene.start, scene.start) == Vector3::Zero());
}

TEST_CASE("common motion: of no vertices, zero") {
  CHECK(common_motion(Positions(0, 3), Positions(0, 3)) == Vector3::Zero());
}
