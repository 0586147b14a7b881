// SPDX-License-Identifier: GPL-3.0-or-later
// Edits test the pairs that earlier edits brought close first, which does not affect the guarantee.
#include <doctest/doctest.h>

#include <random>

#include "editing/sessions.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

constexpr double stride = 0.02;

EditResult edit(EditSession& session, const Controls& goal) {
  Execution execution(1);
  return session.edit(goal, execution);
}

/// The upper sheet pressed further onto the lower one.
Controls pressed(const EditSession& session) {
  return moved(session.controls(), upper_sheet, Vector3(0.3 * stride, 0, -stride));
}

/// The upper sheet pressed through the lower one to the side, where some pairs differ.
Controls elsewhere(const Controls& from) { return moved(from, upper_sheet, Vector3(0.25, 0.15, -0.6)); }

/// A session whose sheets touch and have been pressed together a few times.
EditSession pressing(const Scene& scene, const EditOptions& options = {}) {
  EditSession session = session_of(scene, options);
  edit(session, moved(scene.controls, upper_sheet, Vector3(0, 0, -0.51)));
  for (int k = 0; k < 3; ++k) edit(session, pressed(session));
  return session;
}

}  // namespace

TEST_CASE("pairs kept: an edit like the one before searches all pairs once, a restored session twice") {
  const Scene scene = two_sheets();
  EditSession session = pressing(scene), restored = session_of(scene);
  restored.restore(session.controls(), session.controls());
  const Controls goal = pressed(session);
  const EditResult again = edit(session, goal), restarted = edit(restored, goal);
  CHECK(again.status == EditStatus::corrected);
  CHECK(again.counters.detections == 1);
  CHECK(restarted.counters.detections == 2);
  CHECK(again.energy == doctest::Approx(restarted.energy).epsilon(1e-9));
  CHECK(is_free(scene, again.surface));
}

TEST_CASE("pairs kept: a session that was restored gives what a new one gives, to the last bit") {
  const Scene scene = two_sheets();
  EditSession used = pressing(scene), fresh = session_of(scene);
  used.restore(scene.controls, scene.controls);
  const Controls goal = elsewhere(scene.controls);
  CHECK(edit(used, goal).controls == edit(fresh, goal).controls);
}

TEST_CASE("cached candidates: a session whose edit was cancelled continues as if restored") {
  const Scene scene = two_sheets();
  EditSession cancelled = pressing(scene), restored = session_of(scene);
  const Controls before = cancelled.controls(), goal = elsewhere(before);
  Execution execution(1);
  int reports = 0;
  execution.set_progress([&](const char*, double) {
    if (++reports == 2) execution.request_cancel();
  });
  REQUIRE(cancelled.edit(goal, execution).status == EditStatus::cancelled);
  CHECK(cancelled.controls() == before);
  restored.restore(before, before);
  CHECK(edit(cancelled, goal).controls == edit(restored, goal).controls);
}

TEST_CASE("pairs kept: the same bits for one and two threads over a session") {
  const Scene scene = two_sheets(12);
  EditSession first = session_of(scene), second = session_of(scene);
  for (const double down : {-0.45, -0.55, -0.6, -0.65}) {
    const Controls goal = moved(scene.controls, 169, Vector3(0.1, 0, down));
    Execution one(1), two(2);
    CHECK(first.edit(goal, one).controls == second.edit(goal, two).controls);
  }
}

TEST_CASE("pairs kept: whatever way edits go after each other, what they accept is free") {
  const Scene scene = two_sheets();
  std::mt19937 random(3);
  std::normal_distribution<double> way(0, 0.6);
  EditSession session = pressing(scene);
  int touched = 0;
  for (int k = 0; k < 60; ++k) {
    const Vector3 offset(way(random), way(random), way(random));
    const EditResult result = edit(session, moved(session.controls(), upper_sheet / (1 + k % 3), offset));
    CHECK(is_free(scene, result.surface));
    touched += result.counters.rounds > 0;
  }
  CHECK(touched > 5);  // how many depends on the library of random numbers
}
