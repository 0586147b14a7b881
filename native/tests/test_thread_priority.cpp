// SPDX-License-Identifier: GPL-3.0-or-later
#include "thread_priority.hpp"

#include <doctest/doctest.h>

#include <thread>

#if defined(__linux__)
#include <sys/resource.h>

using namespace stiv;

TEST_CASE("thread priority: that of the thread falls, and that of others stays") {
  const auto niceness = [] { return getpriority(PRIO_PROCESS, 0); };
  const int before = niceness();
  int lowered = before;
  std::thread([&] {
    lower_thread_priority();
    lowered = niceness();
  }).join();
  if (before < 19) CHECK(lowered > before);
  CHECK(niceness() == before);
}
#endif
