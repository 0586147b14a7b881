// SPDX-License-Identifier: GPL-3.0-or-later
#include "usable_processors.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>
#include <thread>

#if defined(__linux__)
#include <sched.h>
#endif

#include "stiv/error.hpp"

namespace stiv {

namespace {

/// Those that the operating system lets this process have; 0 if unknown.
int allowed_processors() {
#if defined(__linux__)
  // hardware_concurrency counts all of the machine, also where a container or a scheduler of jobs left this process
  // few.
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
  return static_cast<int>(std::thread::hardware_concurrency());
}

int limited(int processors) {
  const char* set = std::getenv("STIV_THREADS");
  if (set == nullptr || *set == '\0') return processors;
  const std::string text(set);
  int most = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), most);
  if (error != std::errc() || end != text.data() + text.size() || most < 1)
    throw InputError("STIV_THREADS: expected a whole number from 1 up, not '" + text +
                     "'; unset it for all processors");
  return std::min(processors, most);
}

}  // namespace

int usable_processors() { return limited(std::max(1, allowed_processors())); }

}  // namespace stiv
