// SPDX-License-Identifier: GPL-3.0-or-later
#include "thread_pool.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <string>

#if defined(__linux__)
#include <sched.h>
#endif
#if defined(__x86_64__) || defined(_M_X64)
#include <immintrin.h>
#endif

#include "stiv/error.hpp"

namespace stiv {

namespace {

/// The processors that this process may use; 0 if unknown.
int allowed_processors() {
#if defined(__linux__)
  // hardware_concurrency counts the whole machine, even in a container or under a job scheduler.
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

/// How long a thread polls before it sleeps. To wake it up takes as long as many loops, and most loops of a call follow
/// each other within this time.
constexpr std::chrono::microseconds polling_time(100);

/// Lets the other thread of the same core work, and saves power.
void pause() {
#if defined(__x86_64__) || defined(_M_X64)
  _mm_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Waits a short time for a condition. Returns whether it holds.
template <class Condition>
bool poll(const Condition& holds) {
  using Clock = std::chrono::steady_clock;
  constexpr int tries_per_look = 16;  // at the clock
  const Clock::time_point end = Clock::now() + polling_time;
  do {
    for (int k = 0; k < tries_per_look; ++k) {
      if (holds()) return true;
      pause();
    }
  } while (Clock::now() < end);
  return false;
}

}  // namespace

int usable_processors() { return limited(std::max(1, allowed_processors())); }

ThreadPool::ThreadPool(int count) : polls_(count < allowed_processors()) {
  threads_.reserve(static_cast<std::size_t>(count));
  try {
    for (int k = 1; k <= count; ++k) threads_.emplace_back([this, k] { wait_for_work(k); });
  } catch (const std::exception&) {
    return;  // fewer threads are enough
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    ++number_;
  }
  begun_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ThreadPool::run(const std::function<void(int thread)>& work) {
  {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    ++number_;
  }
  begun_.notify_all();
  work(0);
  {
    const std::lock_guard lock(mutex_);
    work_ = nullptr;
  }
  const auto have_ended = [this] { return busy_ == 0; };
  if (polls_ && poll(have_ended)) return;
  std::unique_lock lock(mutex_);
  ended_.wait(lock, have_ended);
}

void ThreadPool::wait_for_work(int thread) {
  for (std::uint64_t seen = 0;;) {
    const auto is_called = [&] { return number_ != seen; };
    const bool is_awake = polls_ && poll(is_called);
    std::unique_lock lock(mutex_);
    if (!is_awake) begun_.wait(lock, is_called);
    seen = number_;
    if (closing_) return;
    if (work_ == nullptr) continue;  // it has ended already
    const std::function<void(int)>& work = *work_;
    ++busy_;
    lock.unlock();
    work(thread);
    lock.lock();
    if (--busy_ == 0) ended_.notify_one();
  }
}

}  // namespace stiv
