// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "editing/sessions.hpp"
#include "stiv/acceptance/step_check.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

/// Drags to a goal in calls without time, until one accepts a state or ends by itself.
struct HurriedDrag {
  EditResult result;
  int calls = 0;
};

HurriedDrag drag_hurried(EditSession& session, const Controls& goal) {
  HurriedDrag drag;
  do {
    Execution execution(1);
    execution.set_time_budget(1e-9, BudgetEnd::after_checkpoint);
    drag.result = session.drag(goal, execution);
  } while (++drag.calls < 200 && drag.result.status == EditStatus::budget && drag.result.path.empty());
  return drag;
}

}  // namespace

TEST_CASE("session: a drag whose time ended continues with its increment, and accepts the same state") {
  const Scene scene = two_sheets();
  EditSession hurried = session_of(scene), unhurried = session_of(scene);
  Execution execution(1);
  const Controls first = moved(scene.controls, upper_sheet, Vector3(0.01, 0, -0.6));
  unhurried.drag(first, execution);
  hurried.drag(first, execution);
  REQUIRE(hurried.controls() == unhurried.controls());
  // Now beside the goal, so the increment differs from the motion to the goal.
  const Controls second = moved(scene.controls, upper_sheet, Vector3(0.05, 0.02, -0.7));
  const HurriedDrag drag = drag_hurried(hurried, second);
  CHECK(drag.calls > 1);
  CHECK(is_free(scene, hurried.surface()));
  const EditResult at_once = unhurried.drag(second, execution);
  REQUIRE(!at_once.path.empty());
  REQUIRE(!drag.result.path.empty());
  CHECK(drag.result.path.front() == at_once.path.front());
}

TEST_CASE("session: a drag whose time ended before anything was accepted leaves the next one its whole increment") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene), other = session_of(scene);
  Execution execution(1), hurry(1);
  const Controls first = moved(scene.controls, upper_sheet, Vector3(0.01, 0, -0.6));
  session.drag(first, execution);
  other.drag(first, execution);
  hurry.set_time_budget(1e-9, BudgetEnd::after_checkpoint);
  const EditResult ended = session.drag(moved(scene.controls, upper_sheet, Vector3(0.02, 0, -0.9)), hurry);
  REQUIRE(ended.status == EditStatus::budget);
  REQUIRE(ended.path.empty());
  const Controls back = moved(scene.controls, upper_sheet, Vector3(0.03, 0, -0.5));
  CHECK(session.drag(back, execution).controls == other.drag(back, execution).controls);
}

TEST_CASE("session: a step between surfaces is tested as the kept check does it") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  for (const double depth : {0.0, -1e-9, -0.2, -2.0}) {
    const Positions end = scene.deformation->surface(moved(scene.controls, upper_sheet, Vector3(0, 0, depth)));
    Execution execution(1);
    Detector detector(scene.surface);
    IntersectionTest intersections(scene.surface);
    const bool expected = is_step_free(detector, intersections, session.surface(), end, {}, execution);
    CHECK(session.is_step_free(session.surface(), end, execution) == expected);
    CHECK(expected == (depth > -0.3));
  }
}

TEST_CASE("session: hurried drags accept something on the way into contact, and come all the way back from it") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  int accepted = 0;
  for (int step = 1; step <= 8; ++step) {
    const HurriedDrag drag = drag_hurried(session, moved(scene.controls, upper_sheet, Vector3(0.02, 0, -0.15) * step));
    CHECK(is_free(scene, session.surface()));
    accepted += drag.result.path.empty() ? 0 : 1;
  }
  CHECK(accepted > 4);
  EditResult result;
  for (int call = 0; call < 500 && (call == 0 || result.status != EditStatus::reached); ++call) {
    Execution execution(1);
    execution.set_time_budget(1e-9, BudgetEnd::after_checkpoint);
    result = session.drag(scene.controls, execution);
  }
  CHECK(result.status == EditStatus::reached);
  CHECK((session.controls() - scene.controls).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("session: drags without contacts, each cut by its time, reach a far goal in a few calls") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  for (int step = 1; step <= 8; ++step)
    drag_hurried(session, moved(scene.controls, upper_sheet, Vector3(0, 0, 0.1) * step));
  const Controls goal = moved(scene.controls, upper_sheet, Vector3(0, 0, 4));
  EditResult result;
  int calls = 0;
  for (; calls < 500 && (calls == 0 || result.status != EditStatus::reached); ++calls) {
    Execution execution(1);
    execution.set_time_budget(1e-9, BudgetEnd::after_checkpoint);
    result = session.drag(goal, execution);
  }
  CHECK(calls <= 4);
}

TEST_CASE("session: a drag that hands over ends at the first state that it accepts, and the next call continues") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene), other = session_of(scene);
  Execution execution(1);
  const Controls goal = moved(scene.controls, upper_sheet, Vector3(0.01, 0, -0.6));
  const EditResult whole = other.drag(goal, execution);
  EditResult handed = session.drag(goal, execution, 0.0);
  REQUIRE(handed.status == EditStatus::budget);
  REQUIRE(handed.path.size() == 1);
  CHECK(handed.path.front() == whole.path.front());
  const double first = handed.energy;
  for (int call = 0; call < 100 && handed.status == EditStatus::budget; ++call) {
    handed = session.drag(goal, execution, 0.0);
    CHECK(handed.path.size() <= 1);
    CHECK(is_free(scene, session.surface()));
  }
  CHECK(handed.status != EditStatus::budget);
  CHECK(handed.energy <= first);
}

TEST_CASE("session: a drag that arrives at its goal has reached it, whenever it hands over") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  Execution execution(1);
  const Controls goal = moved(scene.controls, upper_sheet, Vector3(0, 0, 0.5));
  CHECK(session.drag(goal, execution, 0.0).status == EditStatus::reached);
}

TEST_CASE("session: a drag that hands over pulls with its strides, and ends as near as one that does not") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene), other = session_of(scene);
  Execution execution(1);
  EditResult whole, handed;
  for (int step = 1; step <= 12; ++step) {
    const Controls goal = moved(scene.controls, upper_sheet, Vector3(0.01, 0, -0.05) * step);
    whole = other.drag(goal, execution);
    handed = session.drag(goal, execution, step % 2 == 0 ? 0.0 : 1e6);
    CHECK(is_free(scene, session.surface()));
  }
  CHECK(handed.energy <= 1.05 * whole.energy);
  const double settled = other.settle(execution).energy;
  CHECK(session.settle(execution).energy <= 1.01 * settled);
}
