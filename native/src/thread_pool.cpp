// SPDX-License-Identifier: GPL-3.0-or-later
#include "thread_pool.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <exception>
#include <string>

#if defined(__linux__)
#include <sched.h>
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

}  // namespace

int usable_processors() { return limited(std::max(1, allowed_processors())); }

ThreadPool::ThreadPool(int count) {
  threads_.reserve(static_cast<std::size_t>(count));
  try {
    for (int k = 0; k < count; ++k) threads_.emplace_back([this] { wait_for_work(); });
  } catch (const std::exception&) {
    return;  // fewer threads are enough
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  begun_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ThreadPool::run(const std::function<void()>& work) {
  {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    ++number_;
  }
  begun_.notify_all();
  work();
  std::unique_lock lock(mutex_);
  work_ = nullptr;
  ended_.wait(lock, [this] { return busy_ == 0; });
}

void ThreadPool::wait_for_work() {
  std::uint64_t done = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    begun_.wait(lock, [&] { return closing_ || (work_ != nullptr && number_ != done); });
    if (closing_) return;
    const std::function<void()>& work = *work_;
    done = number_;
    ++busy_;
    lock.unlock();
    work();
    lock.lock();
    if (--busy_ == 0) ended_.notify_one();
  }
}

}  // namespace stiv
