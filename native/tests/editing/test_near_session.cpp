// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/near_session.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>

#include "stiv/error.hpp"

using namespace stiv;

namespace {

const Eigen::AlignedBox3d box(Vector3(0, 0, 0), Vector3(1, 1, 1));

std::unique_ptr<NearSession> session_with_body(Index body) {
  auto made = std::make_unique<NearSession>();
  made->scene.obstacle_bodies = {body};
  return made;
}

}  // namespace

TEST_CASE("next session: the same is taken, whether another thread made it or this one") {
  for (const int threads : {1, 2, 4}) {
    std::atomic<int> calls = 0;
    NextSession next(box, threads, [&](Execution&) { return session_with_body(++calls); });
    Execution execution(threads);
    CHECK(next.take(execution)->scene.obstacle_bodies == std::vector<Index>{1});
    CHECK(calls == 1);
  }
}

TEST_CASE("next session: one that is not wanted any more ends its work at once") {
  std::atomic<bool> started = false, ended = false;
  {
    const NextSession next(box, 2, [&](Execution& execution) {
      started = true;
      try {
        while (true) execution.check();
      } catch (const Interrupted&) {
        ended = true;
        throw;
      }
      return session_with_body(0);
    });
    while (!started) {
    }
  }
  CHECK(ended);
}

TEST_CASE("next session: what another thread cannot make is made in that of the caller, which learns the reason") {
  std::atomic<int> calls = 0;
  NextSession next(box, 2, [&](Execution& execution) -> std::unique_ptr<NearSession> {
    int called = 0;
    execution.call_owner([&] { called = ++calls; });  // as an observed deformation does
    if (called == 1) return session_with_body(7);
    throw std::runtime_error("the reason");
  });
  Execution execution(2);
  CHECK(next.take(execution)->scene.obstacle_bodies == std::vector<Index>{7});
  CHECK(calls == 1);  // not from the other thread
  CHECK_THROWS_WITH(next.take(execution), "the reason");
}

TEST_CASE("next session: a cancelled call leaves it to the next one") {
  std::atomic<bool> may_end = false;
  NextSession next(box, 2, [&](Execution&) {
    while (!may_end) {
    }
    return session_with_body(3);
  });
  Execution cancelled(2), execution(2);
  cancelled.request_cancel();
  CHECK_THROWS_AS(next.take(cancelled), Interrupted);
  may_end = true;
  CHECK(next.take(execution)->scene.obstacle_bodies == std::vector<Index>{3});
}
