// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/broad_phase/frame_motions.hpp"
#include "detection/broad_phase/step.hpp"
#include "detection/broad_phase/swept_vertices.hpp"
#include "detection/scenes.hpp"

using namespace stiv;

namespace {

using Change = SweptVertices::Change;

Change update_in_frames(SweptVertices& swept, const Surface& surface, const Positions& start, const Positions& end) {
  const Execution execution(2);
  return swept.update({start, end, {0.01, 0.5}, FrameChooser(surface, 1).choose(start, end)}, execution);
}

double longest_side(const PackedBox& box) {
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    longest = std::max(longest, -double(box.values[axis + 3]) - double(box.values[axis]));
  return longest;
}

Change update(SweptVertices& swept, const Positions& start, const Positions& end, double separation = 0.01) {
  const Execution execution(2);
  return swept.update({start, end, {separation, 0.5}, {common_motion(start, end), {}}}, execution);
}

}  // namespace

TEST_CASE("swept vertices: boxes change where the step does") {
  const MovingScene scene = stirred_sheets(20, 2, 0.05, 1);
  const Surface& surface = *scene.surface;
  const Positions motion = scene.end - scene.start;
  SweptVertices swept(surface);
  CHECK(update(swept, scene.start, scene.end) == Change::all);
  const auto before = swept.boxes();
  CHECK(update(swept, scene.start, scene.end) == Change::none);
  CHECK(update(swept, scene.start, scene.start + 0.3 * motion) == Change::none);
  CHECK(update(swept, scene.start, scene.end + 0.0003 * Positions(motion.rowwise().reverse())) == Change::none);
  Positions end = scene.end;
  end(7, 2) += 1;
  CHECK(update(swept, scene.start, end) == Change::some);
  CHECK(swept.changed() == std::vector<Index>{7});
  for (std::size_t vertex = 0; vertex < before.size(); ++vertex)
    CHECK((swept.boxes()[vertex].values == before[vertex].values) == (vertex != 7));
  CHECK(update(swept, scene.start, end, 0.02) == Change::all);
  CHECK(update(swept, scene.start, end.array() + 1e3, 0.02) == Change::all);
}

TEST_CASE("swept vertices: vector code makes the boxes and coarse steps that bodies with the common frame have") {
  const MovingScene scene = stirred_sheets(9, 3, 0.05, 4);
  const Positions end = scene.end.rowwise() + Eigen::RowVector3d(3, -2, 1);
  const Vector3 motion(2.9, -2.1, 1.2);
  SweptVertices common(*scene.surface), framed(*scene.surface);
  const std::vector<Vector3> motions(scene.surface->bodies().size(), motion);
  common.update({scene.start, end, {0.01, 0.5}, {motion, {}}}, Execution(2));
  framed.update({scene.start, end, {0.01, 0.5}, {motion, motions}}, Execution(2));
  REQUIRE(framed.motions().has_own_frames());
  CHECK(common.coarse_bounds().clearance == framed.coarse_bounds().clearance);
  for (std::size_t vertex = 0; vertex < common.boxes().size(); ++vertex) {
    CHECK(common.boxes()[vertex].values == framed.boxes()[vertex].values);
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(common.coarse_steps()[vertex].start[k] == framed.coarse_steps()[vertex].start[k]);
      CHECK(common.coarse_steps()[vertex].end[k] == framed.coarse_steps()[vertex].end[k]);
    }
  }
}

TEST_CASE("swept vertices: a motion common to all leaves the boxes small, and less of it all holds") {
  const MovingScene scene = stirred_sheets(20, 2, 0.001, 2);
  const Eigen::RowVector3d carried(3, -2, 1);
  const Positions end = scene.end.rowwise() + carried;
  SweptVertices swept(*scene.surface);
  update(swept, scene.start, end);
  for (const PackedBox& box : swept.boxes())
    for (std::size_t axis = 0; axis < 3; ++axis) CHECK(-box.values[axis + 3] - box.values[axis] < 0.02);
  CHECK(update(swept, scene.start, end) == Change::none);
  CHECK(update(swept, scene.start, scene.start + 0.5 * (end - scene.start)) == Change::none);
  Positions part = end;
  part.row(0) = scene.start.row(0);
  CHECK(update(swept, scene.start, part) == Change::all);  // another mean
}

TEST_CASE("swept vertices: the boxes of vertices at rest stay, whatever the others do") {
  const MovingScene scene = stirred_sheets(20, 2, 0, 3);
  SweptVertices swept(*scene.surface);
  Positions start = scene.start;
  update(swept, start, start);
  const auto before = swept.boxes();
  for (int edit = 0; edit < 5; ++edit) {
    Positions end = start;
    end.topRows(100).col(2).array() += 0.07;
    CHECK(update(swept, start, end) == Change::some);
    for (std::size_t vertex = 100; vertex < before.size(); ++vertex)
      CHECK(swept.boxes()[vertex].values == before[vertex].values);
    start = end;
  }
}

TEST_CASE("swept vertices: a body in a frame of its own has small boxes, and leaves those of others as they are") {
  const Vector3 carried(3, -2, 1);
  const MovingScene scene = carried_sheets(20, {Vector3::Zero(), carried, Vector3::Zero()}, 0.001, 4);
  const Surface& surface = *scene.surface;
  SweptVertices swept(surface);
  update_in_frames(swept, surface, scene.start, scene.start - 2 * (scene.end - scene.start));  // as far as it goes
  update_in_frames(swept, surface, scene.start, scene.start + 1e-3 * (scene.end - scene.start).rowwise().reverse());
  const auto before = swept.boxes();
  CHECK(update_in_frames(swept, surface, scene.start, scene.end) == Change::some);
  CHECK(swept.changed_bodies() == std::vector<unsigned char>{0, 1, 0});
  for (std::size_t vertex = 0; vertex < before.size(); ++vertex) {
    const bool moves = surface.body_of(static_cast<Index>(vertex)) == 1;
    CHECK((swept.boxes()[vertex].values == before[vertex].values) != moves);
    CHECK(longest_side(swept.boxes()[vertex]) < 0.03);
  }
  CHECK(update_in_frames(swept, surface, scene.start, scene.start + 0.5 * (scene.end - scene.start)) == Change::none);
  Positions part = scene.end;
  part.row(450) = scene.start.row(450);
  CHECK(update_in_frames(swept, surface, scene.start, part) == Change::some);  // another mean of this body
  CHECK(swept.changed_bodies() == std::vector<unsigned char>{0, 1, 0});
}
