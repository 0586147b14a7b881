// SPDX-License-Identifier: GPL-3.0-or-later
// The thread sanitizer reports any data that a job shares with the threads that poll and cancel it.
#include <doctest/doctest.h>

#include <atomic>
#include <string>
#include <thread>

#include "stiv/error.hpp"
#include "stiv/job.hpp"

using namespace stiv;

namespace {

/// Work without an end of its own.
int until_cancelled(Execution& execution) {
  while (true) {
    execution.report("waiting", 0.5);
    execution.for_chunks(64, 1, [](Index, Index, Index) {});
  }
}

}  // namespace

TEST_CASE("job: cancelled work ends, although it has no end of its own") {
  Job<int> job(until_cancelled, 2);
  while (job.poll().phase != std::string("waiting")) std::this_thread::yield();
  CHECK(job.poll().fraction == 0.5);
  CHECK_FALSE(job.wait_for(0.001));
  job.cancel();
  CHECK_THROWS_AS(job.result(), Interrupted);
  CHECK(job.poll().done);
}

TEST_CASE("job: a job that nobody waits for is cancelled when it is destroyed") {
  std::atomic<bool> ended{false};
  {
    const Job<int> job([&](Execution& execution) {
      try {
        return until_cancelled(execution);
      } catch (const Interrupted&) {
        ended = true;
        throw;
      }
    });
  }
  CHECK(ended);
}

TEST_CASE("job: an exception of the work reaches the caller") {
  const Job<int> job([](Execution&) -> int { throw InputError("seven"); });
  CHECK_THROWS_WITH_AS(job.result(), "seven", InputError);
}
