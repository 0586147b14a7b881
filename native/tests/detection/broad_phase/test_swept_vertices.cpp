// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/broad_phase/step.hpp"
#include "detection/broad_phase/swept_vertices.hpp"
#include "detection/scenes.hpp"

using namespace stiv;

namespace {

using Change = SweptVertices::Change;

Change update(SweptVertices& swept, const Positions& start, const Positions& end, double separation = 0.01) {
  const Execution execution(2);
  return swept.update({start, end, {separation, 0.5}, common_motion(start, end)}, execution);
}

}  // namespace

TEST_CASE("swept vertices: boxes change where the step does") {
  const MovingScene scene = stirred_sheets(20, 2, 0.05, 1);
  const Surface& surface = *scene.surface;
  const Positions motion = scene.end - scene.start;
  SweptVertices swept(surface);
  CHECK(update(swept, scene.start, scene.end) == Change::all);
  const std::vector<PackedBox> before = swept.boxes();
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
  const std::vector<PackedBox> before = swept.boxes();
  for (int edit = 0; edit < 5; ++edit) {
    Positions end = start;
    end.topRows(100).col(2).array() += 0.07;
    CHECK(update(swept, start, end) == Change::some);
    for (std::size_t vertex = 100; vertex < before.size(); ++vertex)
      CHECK(swept.boxes()[vertex].values == before[vertex].values);
    start = end;
  }
}
