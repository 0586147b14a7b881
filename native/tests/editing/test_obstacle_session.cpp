// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/obstacle_session.hpp"

#include <doctest/doctest.h>

#include "editing/sessions.hpp"
#include "large_array.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

/// A rigid plate of size 1 above a wall of 40 x 40 with 28,800 triangles, and a session with the wall as its obstacle.
struct PlateOverWall {
  Positions plate = Positions(0, 3), wall = Positions(0, 3);
  Triangles plate_faces = Triangles(0, 3), wall_faces = Triangles(0, 3);
  std::shared_ptr<const Surface> surface;
  std::shared_ptr<const Deformation> deformation;
  Controls controls;

  PlateOverWall() {
    append_sheet(plate, plate_faces, 3, 1, Vector3(0.03, 0.02, 0.5));
    append_sheet(wall, wall_faces, 120, 40, Vector3::Zero());
    SurfaceDefinition definition;
    definition.vertex_count = static_cast<Index>(plate.rows());
    definition.triangles = plate_faces;
    definition.bodies = {{"plate", Mobility::rigid}};
    surface = std::make_shared<Surface>(definition);
    deformation = make_rigid(plate);
    controls = rigid_rest_controls(plate);
  }

  EditSession session(int threads = 1) const {
    Execution execution(threads);
    EditOptions options;
    options.threads = threads;
    return {surface, deformation, controls, options, {std::make_shared<Obstacle>("wall", wall, wall_faces)}, execution};
  }

  /// By the exact test of the whole scene.
  bool is_clear(const Positions& moved) const {
    Triangles triangles(plate_faces.rows() + wall_faces.rows(), 3);
    triangles << plate_faces, wall_faces.array() + static_cast<Index>(plate.rows());
    Positions q(plate.rows() + wall.rows(), 3);
    q << moved, wall;
    const Index count = static_cast<Index>(plate.rows());
    const auto whole = surface_of(triangles, count, static_cast<Index>(wall.rows()), Mobility::rigid, Mobility::fixed);
    Execution execution(1);
    return IntersectionTest(whole).find(q, execution).empty();
  }
};

}  // namespace

TEST_CASE("obstacle session: a far drag over and through an obstacle stays clear of all of it") {
  const PlateOverWall scene;
  EditSession session = scene.session();
  for (int tick = 1; tick <= 30; ++tick) {
    Execution execution(1);
    const EditResult result =
        session.drag(moved(scene.controls, 1, Vector3(0.5 * tick, 0.1 * tick, -0.06 * tick)), execution);
    CHECK(result.surface.rows() == scene.plate.rows());
    CHECK(scene.is_clear(result.surface));
    CHECK(result.surface.col(2).minCoeff() > 0);
    for (const Controls& p : result.path) CHECK(scene.is_clear(scene.deformation->surface(p)));
  }
  CHECK(session.surface()(0, 0) > scene.plate(0, 0) + 14);
}

TEST_CASE("obstacle session: one edit to the other end of an obstacle, far beyond the first box") {
  const PlateOverWall scene;
  EditSession session = scene.session();
  Execution execution(1);
  const EditResult result = session.edit(moved(scene.controls, 1, Vector3(15, 0, -2)), execution);
  CHECK(result.status != EditStatus::reached);
  CHECK(result.surface.col(2).minCoeff() > 0);
  CHECK(scene.is_clear(result.surface));
}

TEST_CASE("obstacle session: the same bits for any number of threads, in boxes that are left and entered again") {
  const PlateOverWall scene;
  EditSession one = scene.session(1), two = scene.session(2), four = scene.session(4);
  constexpr int turn = 16, ticks = 34;
  for (int tick = 1; tick <= ticks; ++tick) {
    const int distance = tick <= turn ? tick : 2 * turn - tick;  // the last ticks lead beyond the start
    const Controls goal = moved(scene.controls, 1, Vector3(0.5 * distance, 0.1 * distance, -0.04 * distance));
    const auto drag = [&](EditSession& session, int threads) {
      Execution execution(threads);
      return session.drag(goal, execution);
    };
    const EditResult result = drag(one, 1);
    CHECK(drag(two, 2).controls == result.controls);
    CHECK(drag(four, 4).controls == result.controls);
    CHECK(scene.is_clear(result.surface));
    if (tick == turn) CHECK(result.surface(0, 0) > scene.plate(0, 0) + 7);
    if (tick == ticks) CHECK(result.status == EditStatus::reached);
  }
  for (EditSession* session : {&one, &two, &four}) session->end_drag();
  CHECK(MemoryReuse::kept_bytes() == 0);
}

TEST_CASE("obstacle session: a call that is cancelled at any time, also while it opens a box, changes nothing") {
  const PlateOverWall scene;
  int cancelled = 0, ended = 0;
  for (int polls = 1; polls < 20000 && ended == 0; polls *= 2) {
    EditSession session = scene.session();
    Execution near(1), far(1), again(1);
    const Controls before = session.drag(moved(scene.controls, 1, Vector3(0.3, 0, -0.3)), near).controls;
    int polled = 0;
    far.cancel_when([&] { return ++polled > polls; });
    const EditResult result = session.drag(moved(scene.controls, 1, Vector3(9, 0, -2)), far);
    ++(result.status == EditStatus::cancelled ? cancelled : ended);
    CHECK((result.status != EditStatus::cancelled || session.controls() == before));
    const EditResult next = session.drag(moved(scene.controls, 1, Vector3(12, 0, -1)), again);
    CHECK(next.surface(0, 0) > scene.plate(0, 0) + 11);
    CHECK(scene.is_clear(next.surface));
  }
  CHECK(cancelled > 5);
  CHECK(ended == 1);
}

TEST_CASE("obstacle session: a cancelled call changes nothing, though its path left the box") {
  const PlateOverWall scene;
  EditSession session = scene.session();
  Execution execution(1);
  execution.request_cancel();
  const EditResult result = session.drag(moved(scene.controls, 1, Vector3(9, 0, -2)), execution);
  CHECK(result.status == EditStatus::cancelled);
  CHECK(session.controls() == scene.controls);
  Execution again(1);
  CHECK(session.drag(moved(scene.controls, 1, Vector3(0.1, 0, 0)), again).status == EditStatus::reached);
}

TEST_CASE("obstacle session: bodies keep their numbers, whichever obstacles are near") {
  const PlateOverWall scene;
  Positions distant(0, 3);
  Triangles distant_faces(0, 3);
  append_sheet(distant, distant_faces, 3, 1, Vector3(500, 0, 0));
  const auto far = std::make_shared<Obstacle>("far", distant, distant_faces);
  const auto wall = std::make_shared<Obstacle>("wall", scene.wall, scene.wall_faces);
  const Controls below = moved(scene.controls, 1, Vector3(0, 0, -2));
  EditOptions options;
  options.threads = 1;
  Execution execution(1);

  options.pair_separations = {{0, 3, 0.01}, {2, 0, 0.2}};
  EditSession kept_apart(scene.surface, scene.deformation, scene.controls, options, {far, wall, far}, execution);
  CHECK(kept_apart.edit(below, execution).surface.col(2).minCoeff() >= 0.2);

  options.pair_separations = {{0, 3, 0.2}};
  options.max_rounds = 1;
  EditSession blocked(scene.surface, scene.deformation, scene.controls, options, {far, wall, far}, execution);
  const EditResult result = blocked.edit(below, execution);
  CHECK(result.surface.col(2).minCoeff() < 0.2);
  CHECK(result.status == EditStatus::blocked);
  CHECK(result.blocking == std::vector<Index>{0, 2});

  options.pair_separations = {{0, 4, 0.2}};
  CHECK_THROWS_WITH_AS(
      EditSession(scene.surface, scene.deformation, scene.controls, options, {far, wall, far}, execution),
      "pair_separations: there is no body 4, only 0..3", InputError);
}

TEST_CASE("obstacle session: exclusions and overlaps of obstacles are refused") {
  const PlateOverWall scene;
  const Obstacles obstacles{std::make_shared<Obstacle>("wall", scene.wall, scene.wall_faces)};
  Execution execution(1);
  const auto open = [&](const EditOptions& options) {
    EditSession(scene.surface, scene.deformation, scene.controls, options, obstacles, execution);
  };
  EditOptions excluding, overlapping;
  excluding.excluded = {{0, static_cast<Index>(scene.plate_faces.rows())}};
  overlapping.overlapping = {{0, 1}};
  CHECK_THROWS_AS(open(excluding), InputError);
  CHECK_THROWS_AS(open(overlapping), InputError);
  CHECK_NOTHROW(open({}));
}
