// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions on threads of their own. The thread sanitizer then reports any data that they share.
#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "editing/small_scenes.hpp"
#include "stiv/editing/session.hpp"
#include "stiv/error.hpp"
#include "stiv/job.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

/// Results of a drag, settling and an edit.
std::array<Controls, 3> solved(const Scene& scene, double shift) {
  EditSession session(scene.surface, scene.deformation, scene.controls);
  Controls goal = scene.controls;
  goal.topRows(scene.controls.rows() / 3).rowwise() += Eigen::RowVector3d(shift, -shift / 2, -0.8);
  Execution first(2), second(2), third(2);
  const Controls dragged = session.drag(goal, first).controls;
  const Controls settled = session.settle(second).controls;
  return {dragged, settled, session.edit(scene.controls, third).controls};
}

Controls lowered(const Scene& scene) {
  Controls goal = scene.controls;
  goal.topRows(169).rowwise() += Eigen::RowVector3d(0.1, 0, -0.8);
  return goal;
}

}  // namespace

TEST_CASE("sessions: four parallel ones over one surface give exactly the serial results") {
  const Scene scene = two_sheets(8);
  constexpr std::size_t count = 4;
  std::array<std::array<Controls, 3>, count> alone, at_once;
  for (std::size_t k = 0; k < count; ++k) alone[k] = solved(scene, 0.1 * static_cast<double>(k));
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < count; ++k)
    threads.emplace_back([&, k] { at_once[k] = solved(scene, 0.1 * static_cast<double>(k)); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t k = 0; k < count; ++k) CHECK(at_once[k] == alone[k]);
  CHECK(alone[0] != alone[1]);
}

TEST_CASE("sessions: cancelled from another thread at any moment, nothing is left of it") {
  const Scene scene = two_sheets(12);
  EditSession session(scene.surface, scene.deformation, scene.controls);
  const Controls before = session.controls();
  const Controls goal = lowered(scene);
  for (int waits = 1; waits <= 1 << 14; waits *= 4) {
    std::atomic<bool> flag{false};
    Execution execution(2);
    execution.cancel_when([&] { return flag.load(); });
    std::thread other([&] {
      for (int k = 0; k < waits; ++k) std::this_thread::yield();
      flag = true;
    });
    const EditResult result = session.edit(goal, execution);
    other.join();
    if (result.status == EditStatus::cancelled) CHECK(session.controls() == before);
    session.restore(before);
  }
}

TEST_CASE("sessions: a job solves with the same bits as a synchronous call") {
  const Scene scene = two_sheets(12);
  const Controls goal = lowered(scene);
  EditSession first(scene.surface, scene.deformation, scene.controls);
  Execution execution(2);
  const EditResult expected = first.edit(goal, execution);
  EditSession second(scene.surface, scene.deformation, scene.controls);
  const Job<EditResult> job([&](Execution& own) { return second.edit(goal, own); }, 2);
  const EditResult& result = job.result();
  CHECK(job.poll().done);
  CHECK(job.poll().fraction > 0);
  CHECK(result.status == expected.status);
  CHECK(result.controls == expected.controls);
  CHECK(result.path == expected.path);
  CHECK(second.surface() == first.surface());
}

TEST_CASE("sessions: a cancelled job keeps the state before it, and cancelled construction is interrupted") {
  const Scene scene = two_sheets(12);
  EditSession session(scene.surface, scene.deformation, scene.controls);
  Job<EditResult> job(
      [&](Execution& execution) {
        while (!execution.cancel_requested()) std::this_thread::yield();
        return session.edit(lowered(scene), execution);
      },
      2);
  job.cancel();
  CHECK(job.result().status == EditStatus::cancelled);
  CHECK(session.controls() == scene.controls);
  Execution cancelled(2);
  cancelled.request_cancel();
  CHECK_THROWS_AS(EditSession(scene.surface, scene.deformation, scene.controls, {}, cancelled), Interrupted);
}
