// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/broad_phase/frame_motions.hpp"
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

TEST_CASE("frame motions: a body has its own frame if most of its motion is alike, and it is not the common one") {
  const Vector3 carried(3, -2, 1), other(-1, 2, 0);
  const auto motions_of = [](const std::vector<Vector3>& displacements, double stir) {
    const MovingScene scene = carried_sheets(12, displacements, stir, 1);
    return FrameChooser(*scene.surface, 1).choose(scene.start, scene.end);
  };
  const FrameMotions one = motions_of({Vector3::Zero(), carried, Vector3::Zero()}, 0.001);
  CHECK(one.common == Vector3::Zero());
  CHECK(one.of_body(0) == Vector3::Zero());
  CHECK((one.of_body(1) - carried).norm() < 0.01);
  CHECK(one.of_pair(1, 1) == one.of_body(1));
  CHECK(one.of_pair(0, 1) == one.common);
  const FrameMotions two = motions_of({Vector3::Zero(), carried, other}, 0.001);
  CHECK((two.of_body(1) - carried).norm() < 0.01);
  CHECK((two.of_body(2) - other).norm() < 0.01);
  CHECK_FALSE(motions_of({Vector3::Zero(), Vector3::Zero()}, 0.001).has_own_frames());
  CHECK_FALSE(motions_of({Vector3::Zero(), 0.1 * carried}, 1).has_own_frames());  // stirred more than it is carried
  CHECK_FALSE(motions_of({carried}, 0.001).has_own_frames());
  CHECK(one.go_far);
  const FrameMotions near = motions_of({Vector3::Zero(), 3.0 / 11 * Vector3::UnitX()}, 1e-6);  // three edges
  CHECK((near.has_own_frames() && !near.go_far));
}

TEST_CASE("frame motions: rigid bodies share the common frame, because they are not tested against themselves") {
  const MovingScene scene = carried_sheets(12, {Vector3::Zero(), Vector3(3, -2, 1), Vector3::Zero()}, 0, 1);
  SurfaceDefinition definition = scene.surface->definition();
  definition.bodies[1].mobility = Mobility::rigid;
  CHECK_FALSE(FrameChooser(Surface(definition), 1).choose(scene.start, scene.end).has_own_frames());
}

TEST_CASE("frame motions: a small body shares the common frame") {
  const MovingScene scene = carried_sheets(12, {Vector3::Zero(), Vector3(3, -2, 1)}, 0.001, 1);
  CHECK(FrameChooser(*scene.surface, 144).choose(scene.start, scene.end).has_own_frames());
  CHECK_FALSE(FrameChooser(*scene.surface, 145).choose(scene.start, scene.end).has_own_frames());
}

TEST_CASE("common motion: of no vertices, zero") {
  CHECK(common_motion(Positions(0, 3), Positions(0, 3)) == Vector3::Zero());
}
