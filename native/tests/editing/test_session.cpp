// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "editing/sessions.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

EditResult edit(EditSession& session, const Controls& goal) {
  Execution execution(1);
  return session.edit(goal, execution);
}

}  // namespace

TEST_CASE("session: a free goal is reached as it will be stored") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  const Controls goal = moved(scene.controls, upper_sheet, Vector3(0.1, 0.2, 0.3));
  const EditResult result = edit(session, goal);
  CHECK(result.status == EditStatus::reached);
  CHECK(result.controls == as_stored(goal, {{0, static_cast<Index>(goal.rows())}}));
  CHECK(result.events.empty());
  CHECK(result.counters.rounds == 0);
  CHECK(session.controls() == result.controls);
  CHECK(edit(session, result.controls).status == EditStatus::unchanged);
}

TEST_CASE("session: a way too far to be looked at in one piece is gone in parts, free or through a wall") {
  const Scene scene = two_sheets(45);
  constexpr Index upper = 46 * 46;
  EditOptions options;
  options.max_sub_edits = 2;
  options.max_rounds = 4;
  EditSession session = session_of(scene, options);
  const EditResult up = edit(session, moved(scene.controls, upper, Vector3(1.1, 1.2, 1.3)));
  CHECK(up.status == EditStatus::reached);
  CHECK(up.path.size() > 1);
  const EditResult back = edit(session, scene.controls);
  CHECK(back.status == EditStatus::reached);
  const EditResult down = edit(session, moved(scene.controls, upper, Vector3(0.1, 0.2, -1)));
  CHECK(is_free(scene, down.surface));
  CHECK(down.energy < 0.25 * 0.5 * upper * (0.01 + 0.04 + 1));  // relative to no motion; measured: 0.219
  CHECK(down.counters.candidate_pairs < (1 << 18) * (down.counters.detections + 1));
}

TEST_CASE("session: a sheet pushed fully through another in one edit ends on its side") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  const EditResult result = edit(session, moved(scene.controls, upper_sheet, Vector3(0, 0, -1)));
  CHECK(result.status == EditStatus::corrected);
  CHECK(is_free(scene, result.surface));
  CHECK(result.patches >= 1);
  CHECK(result.energy < 0.2 * 0.5 * upper_sheet * 0.25);  // relative to staying at the contact; measured: 0.174
  CHECK(result.surface.topRows(upper_sheet).col(2).mean() < 0.3);
  CHECK(result.surface.bottomRows(result.surface.rows() - upper_sheet).col(2).minCoeff() < -0.1);
}

TEST_CASE("session: an edit continues from its first solution, and ends closer to the goal") {
  const Scene scene = two_sheets();
  const Controls goal = moved(scene.controls, upper_sheet, Vector3(0, 0, -0.7));  // too close for sub-goals
  EditOptions first_answer;
  first_answer.max_sub_edits = 1;
  EditSession once = session_of(scene, first_answer), again = session_of(scene);
  const EditResult first = edit(once, goal), refined = edit(again, goal);
  CHECK(first.counters.sub_edits == 1);
  CHECK(refined.counters.sub_edits > 1);
  CHECK(refined.status == EditStatus::corrected);
  CHECK(refined.path.front() == first.controls);
  CHECK(refined.energy < 0.95 * first.energy);  // measured: 0.917
  CHECK(is_free(scene, refined.surface));
}

TEST_CASE("session: a common motion of all is the goal as stored, to the last bit, near contact too") {
  Scene scene = two_sheets();
  scene.controls.topRows(upper_sheet).col(2).array() -= 0.49999;
  EditSession session = session_of(scene);
  const Controls goal = moved(scene.controls, static_cast<Index>(scene.controls.rows()), Vector3(0.25, -4, 0.5));
  const EditResult result = edit(session, goal);
  CHECK(result.status == EditStatus::reached);
  CHECK(result.counters.rounds == 0);
  CHECK(result.controls == as_stored(goal, {{0, static_cast<Index>(goal.rows())}}));
}

TEST_CASE("session: the same bits for one and for two threads") {
  const Scene scene = two_sheets(12);
  const Controls goal = moved(scene.controls, 169, Vector3(0.1, 0, -0.8));
  EditSession first = session_of(scene), second = session_of(scene);
  Execution one(1), two(2);
  CHECK(first.edit(goal, one).controls == second.edit(goal, two).controls);
  CHECK(one.counters.events == two.counters.events);
}

TEST_CASE("session: everything pinned is blocked at the contact and names the bodies") {
  const Scene scene = two_sheets();
  EditOptions options;
  options.weights = Eigen::VectorXd::Zero(scene.controls.rows());
  EditSession session = session_of(scene, options);
  const EditResult result = edit(session, moved(scene.controls, upper_sheet, Vector3(0, 0, -1)));
  CHECK(result.status == EditStatus::blocked);
  CHECK(result.blocking == std::vector<Index>{0, 1});
  CHECK(is_free(scene, result.surface));
  CHECK(result.surface(0, 2) < 0.01);  // it reached the contact
  CHECK(result.surface(0, 2) > 0);
}

TEST_CASE("session: reported events are those of the last responding round, whether anything can yield or not") {
  const Scene scene = two_sheets();
  const Controls goal = moved(scene.controls, upper_sheet, Vector3(0.1, 0.2, -1)).cast<float>().cast<double>();
  for (const double weight : {0.0, 1.0}) {
    EditOptions options;
    options.weights = Eigen::VectorXd::Constant(scene.controls.rows(), weight);
    options.max_sub_edits = options.max_rounds = 1;
    EditSession session = session_of(scene, options);
    const EditResult result = edit(session, goal);
    Execution execution(1);
    const Events all = Detector(scene.surface, {.broad_phase = BroadPhase::brute_force})
                           .find(scene.controls, goal, {session.separation()}, execution);
    CHECK(all.size() > 50);
    REQUIRE(result.events.size() == all.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      CHECK(result.events[k].kind == all[k].kind);
      CHECK(result.events[k].vertices == all[k].vertices);
      CHECK(result.events[k].time == doctest::Approx(all[k].time));
    }
  }
}

TEST_CASE("session: pinned controls do not yield, the others do") {
  const Scene scene = two_sheets();
  EditOptions options;
  options.weights = Eigen::VectorXd::Ones(scene.controls.rows());
  options.weights.head(upper_sheet).setZero();
  EditSession session = session_of(scene, options);
  const Controls goal = moved(scene.controls, upper_sheet, Vector3(0, 0, -0.75));
  const EditResult result = edit(session, goal);
  CHECK(result.status == EditStatus::corrected);
  CHECK(result.controls.topRows(upper_sheet) == goal.topRows(upper_sheet).cast<float>().cast<double>());
  CHECK(is_free(scene, result.surface));
}

TEST_CASE("session: settling never raises the energy") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  const EditResult first = edit(session, moved(scene.controls, upper_sheet, Vector3(0.2, 0, -1.5)));
  Execution execution(1);
  const EditResult settled = session.settle(execution);
  CHECK(settled.energy <= first.energy);
  CHECK(is_free(scene, settled.surface));
}

TEST_CASE("session: a turn by more than the limit is made in steps and reached") {
  const Scene scene = plate_over_wall();
  EditSession session = session_of(scene);
  Controls goal = scene.controls;
  goal.row(1) << 0, 0, 2.5;
  const EditResult result = edit(session, goal);
  CHECK(result.status == EditStatus::reached);
  CHECK(result.counters.sub_edits >= 9);
  Controls tilted = goal;
  tilted(0, 2) = 0.3;
  tilted.row(1) << 0, 1.5, 0;  // one end would stand 0.2 below the wall
  const EditResult stopped = edit(session, tilted);
  CHECK(is_free(scene, stopped.surface));
  CHECK(stopped.surface.topRows(16).col(2).minCoeff() > 0);
}

TEST_CASE("session: cancelling gives the state before, the time budget the last accepted one") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  const Controls goal = moved(scene.controls, upper_sheet, Vector3(0, 0, -1));
  Execution cancelled(1);
  int reports = 0;
  cancelled.set_progress([&](const char*, double) {
    if (++reports == 2) cancelled.request_cancel();
  });
  const EditResult result = session.edit(goal, cancelled);
  CHECK(result.status == EditStatus::cancelled);
  CHECK(result.controls == scene.controls);
  CHECK(session.controls() == scene.controls);

  EditOptions hurried;
  hurried.time_budget = 1e-9;
  EditSession limited = session_of(scene, hurried);
  const EditResult late = edit(limited, goal);
  CHECK(late.status == EditStatus::budget);
  CHECK(is_free(scene, late.surface));
}

TEST_CASE("session: what a time budget ended is taken up again by settling") {
  const Scene scene = two_sheets();
  EditOptions options;
  options.time_budget = 1e-9;  // used up before the first round, of which each call still does one
  EditSession session = session_of(scene, options);
  const Controls goal = moved(scene.controls, upper_sheet, Vector3(0, 0, -1));
  EditResult result = edit(session, goal);
  CHECK(result.status == EditStatus::budget);
  CHECK(result.controls == scene.controls);
  for (int call = 0; call < 100 && result.status == EditStatus::budget; ++call) {
    Execution execution(1);
    result = session.settle(execution);
    CHECK(is_free(scene, result.surface));
  }
  CHECK(result.status == EditStatus::corrected);
  CHECK(result.controls != scene.controls);
}

TEST_CASE("session: bad input is refused by name and changes nothing") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  Controls goal = scene.controls;
  goal(60, 1) = std::nan("");
  CHECK_THROWS_WITH_AS(edit(session, goal), doctest::Contains("object \"wall\", control 60"), InputError);
  goal(60, 1) = 1e300;
  CHECK_THROWS_AS(edit(session, goal), InputError);
  CHECK_THROWS_WITH_AS(edit(session, Controls::Zero(3, 3)), doctest::Contains("(3, 3)"), InputError);
  CHECK(session.controls() == scene.controls);

  EditOptions fine;
  fine.separation = 1e-9;
  CHECK_THROWS_WITH_AS(session_of(scene, fine), doctest::Contains("the least that can be kept"), InputError);
  EditOptions few;
  few.weights = Eigen::VectorXd::Ones(2);
  CHECK_THROWS_AS(session_of(scene, few), InputError);
  CHECK_THROWS_AS(EditSession(scene.surface, make_identity(3), Controls::Zero(3, 3)), InputError);
}

TEST_CASE("session: a start that intersects is refused with its pairs and ways out") {
  Scene scene = two_sheets();
  scene.controls.topRows(upper_sheet).col(2).array() = 0.01 * scene.controls.topRows(upper_sheet).col(0).array();
  try {
    session_of(scene);
    FAIL("accepted");
  } catch (const StartIntersectsError& error) {
    CHECK(error.pairs.size() > 3);
    CHECK(std::string(error.what()).find("object \"mover\", face") != std::string::npos);
    CHECK(std::string(error.what()).find("exclude") != std::string::npos);
  }
  EditSession session = session_of(two_sheets());
  for (int again = 0; again < 2; ++again) {
    CHECK_THROWS_AS(session.restore(scene.controls), StartIntersectsError);
    CHECK(session.controls() == two_sheets().controls);
    session.restore(two_sheets().controls);
    CHECK(session.controls() == two_sheets().controls);
  }
}

TEST_CASE("session: without controls or without a surface nothing happens") {
  const auto empty = std::make_shared<Surface>(SurfaceDefinition{});
  EditSession session(empty, make_identity(0), Controls(0, 3));
  CHECK(edit(session, Controls(0, 3)).status == EditStatus::unchanged);
  const Scene scene = two_sheets();
  EditSession fixed(scene.surface, make_concatenation({}, scene.controls), Controls(0, 3));
  const EditResult result = edit(fixed, Controls(0, 3));
  CHECK(result.status == EditStatus::unchanged);
  CHECK(result.surface == scene.controls);
}

TEST_CASE("session: a scale by a power of two changes no bit") {
  for (const double scale : {std::ldexp(1, -23), std::ldexp(1, 23)}) {
    Scene scene = two_sheets(), scaled = two_sheets();
    scaled.controls *= scale;
    EditOptions exact;
    exact.single_precision = false;
    EditSession a = session_of(scene, exact), b = session_of(scaled, exact);
    const Controls goal = moved(scene.controls, upper_sheet, Vector3(0, 0, -1));
    const EditResult first = edit(a, goal), second = edit(b, scale * goal);
    CHECK(second.status == first.status);
    CHECK(second.controls == scale * first.controls);
  }
}
