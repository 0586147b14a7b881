// SPDX-License-Identifier: GPL-3.0-or-later
// Python's tests compare values, Jacobians and metrics; these are about calls from C++ and its threads.
#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "../../editing/small_scenes.hpp"
#include "stiv/deformation/observed.hpp"
#include "stiv/editing/session.hpp"
#include "stiv/error.hpp"
#include "stiv/job.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

WeightMatrix identity_weights(Index count) {
  WeightMatrix weights(count, count);
  weights.setIdentity();
  return weights;
}

/// Two sheets, of which the upper one bends: z + x^2 / 4. It has no surface lower than `floor`.
struct Bending {
  Scene scene = two_sheets(8);
  Index moving = static_cast<Index>(scene.controls.rows()) / 2;
  double floor = -1e300;
  std::atomic<int> calls{0};
  std::thread::id thread;
  bool fails = false;

  Bending() {
    const Positions rest = scene.controls;
    std::vector<Index> vertices;
    for (Index vertex = 0; vertex < moving; ++vertex) vertices.push_back(vertex);
    const auto bend = [this](const Controls& p) -> std::optional<Positions> {
      ++calls;
      thread = std::this_thread::get_id();
      if (fails) throw std::runtime_error("failed");
      if (p.col(2).minCoeff() < floor) return std::nullopt;
      Positions q = p;
      q.col(2) += p.col(0).cwiseProduct(p.col(0)) / 4;
      return q;
    };
    scene.controls = rest.topRows(moving);
    scene.deformation = make_concatenation({{make_observed(bend, {identity_weights(moving), {}}), vertices}}, rest);
  }

  Controls lowered(double by) const { return scene.controls.rowwise() - Eigen::RowVector3d(0, 0, by); }
  EditSession session() const { return EditSession(scene.surface, scene.deformation, scene.controls); }
};

}  // namespace

TEST_CASE("observed: an edit goes as far as the function has a surface, and stops at contacts") {
  Bending bending;
  EditSession session = bending.session();
  bending.floor = 0.3;
  Execution execution(1);
  const EditResult cut = session.edit(bending.lowered(1), execution);
  CHECK(cut.status == EditStatus::blocked);
  CHECK(execution.counters.infeasible > 0);
  CHECK(cut.controls.col(2).minCoeff() == doctest::Approx(0.3).epsilon(0.02));
  CHECK(cut.controls.col(2).minCoeff() >= 0.3);
  bending.floor = -1e300;
  Execution next(1);
  CHECK(session.edit(bending.lowered(1), next).status == EditStatus::corrected);
  CHECK(next.counters.infeasible == 0);
}

TEST_CASE("observed: a job calls the function in the thread that polls or waits for it") {
  Bending bending;
  EditSession session = bending.session(), same = bending.session();
  Execution execution(1);
  const EditResult expected = same.edit(bending.lowered(1), execution);
  Job<EditResult> job([&](Execution& own) { return session.edit(bending.lowered(1), own); }, 2);
  bending.calls = 0;
  while (bending.calls == 0) job.poll();
  CHECK(bending.thread == std::this_thread::get_id());
  bending.thread = {};
  CHECK(job.result().controls == expected.controls);
  CHECK(bending.thread == std::this_thread::get_id());
}

TEST_CASE("observed: a session is made by a job, and an exception of the function ends the job") {
  Bending bending;
  const auto open = [&](Execution& own) {
    return std::make_shared<EditSession>(bending.scene.surface, bending.scene.deformation, bending.scene.controls,
                                         EditOptions(), own);
  };
  Job<std::shared_ptr<EditSession>> job(open);
  const std::shared_ptr<EditSession> session = job.result();
  CHECK(bending.thread == std::this_thread::get_id());
  bending.fails = true;
  Job<EditResult> failing([&](Execution& own) { return session->edit(bending.lowered(1), own); });
  while (!failing.wait_for(0.001)) continue;
  CHECK_THROWS_WITH(failing.result(), "failed");
  CHECK(session->controls() == bending.scene.controls);
}

TEST_CASE("observed: a job that waits for a call ends when it is cancelled or destroyed") {
  Bending bending;
  EditSession session = bending.session();
  bending.calls = 0;
  {
    Job<EditResult> job([&](Execution& own) { return session.edit(bending.lowered(1), own); });
    job.cancel();
    CHECK(job.result().status == EditStatus::cancelled);
    const Job<EditResult> dropped([&](Execution& own) { return session.edit(bending.lowered(1), own); });
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  CHECK(bending.calls == 0);
  CHECK(session.controls() == bending.scene.controls);
}

TEST_CASE("observed: cancelled within a call from another thread, the work ends after it") {
  Bending bending;
  EditSession session = bending.session();
  Job<EditResult> job([&](Execution& own) { return session.edit(bending.lowered(1), own); });
  bending.calls = 0;
  std::thread canceller([&] {
    while (bending.calls == 0) std::this_thread::yield();
    job.cancel();
  });
  const EditStatus status = job.result().status;
  canceller.join();
  CHECK((status == EditStatus::cancelled || status == EditStatus::corrected));
}
