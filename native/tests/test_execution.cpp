// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <atomic>
#include <cfenv>
#include <mutex>
#include <numeric>
#include <set>
#include <string>
#include <thread>

#include "stiv/error.hpp"
#include "stiv/execution.hpp"

using namespace stiv;

TEST_CASE("execution: chunks cover the range once, for any number of threads") {
  for (const int threads : {1, 2, 5}) {
    const Execution execution(threads);
    std::vector<int> seen(1003, 0);
    execution.for_chunks(1003, 10, [&](Index begin, Index end, Index) {
      for (Index k = begin; k < end; ++k) ++seen[static_cast<std::size_t>(k)];
    });
    CHECK(std::accumulate(seen.begin(), seen.end(), 0) == 1003);
    CHECK(*std::max_element(seen.begin(), seen.end()) == 1);
  }
}

TEST_CASE("execution: threads are kept from loop to loop, and a loop within a loop covers its range as well") {
  const Execution execution(4);
  std::atomic<int> inner{0};
  for (int loop = 0; loop < 200; ++loop) {
    std::atomic<int> outer{0};
    execution.for_chunks(1 + loop % 7, 1, [&](Index, Index, Index) { ++outer; });
    CHECK(outer == 1 + loop % 7);
  }
  std::set<std::thread::id> threads;
  std::mutex mutex;
  execution.for_chunks(64, 1, [&](Index, Index, Index) {
    execution.for_chunks(10, 3, [&](Index begin, Index end, Index) { inner += end - begin; });
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  CHECK(inner == 640);
  CHECK(threads.size() <= 4);
}

TEST_CASE("execution: cancelling and a used up budget interrupt") {
  Execution cancelled(2);
  cancelled.request_cancel();
  CHECK_THROWS_AS(cancelled.for_chunks(10, 1, [](Index, Index, Index) {}), Interrupted);
  Execution late(1);
  late.set_time_budget(0);
  CHECK_THROWS_AS(late.check(), Interrupted);
  Execution gaining(1);
  gaining.set_time_budget(0, BudgetEnd::after_checkpoint);
  CHECK_NOTHROW(gaining.check());
  gaining.checkpoint();
  CHECK_THROWS_AS(gaining.check(), Interrupted);
  std::atomic<bool> flag{false};
  Execution watching(1);
  watching.cancel_when([&] { return flag.load(); });
  CHECK_NOTHROW(watching.check());
  flag = true;
  CHECK_THROWS_AS(watching.check(), Interrupted);
}

TEST_CASE("execution: an exception of a worker reaches the caller; of several, always that of the lowest chunk") {
  const Execution execution(2);
  const auto fail = [](Index begin, Index, Index) {
    if (begin >= 7) throw InputError(std::to_string(begin));
  };
  for (int loop = 0; loop < 100; ++loop) CHECK_THROWS_WITH_AS(execution.for_chunks(20, 1, fail), "7", InputError);
}

TEST_CASE("execution: floating-point mode is set within a scope and given back") {
  std::fesetround(FE_UPWARD);
  {
    const FloatingPointScope scope;
    CHECK(std::fegetround() == FE_TONEAREST);
  }
  CHECK(std::fegetround() == FE_UPWARD);
  std::fesetround(FE_TONEAREST);
}
