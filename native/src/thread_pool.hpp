// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace stiv {

/// How many threads a call takes that is told no number: one for each processor that this process may run on, no more
/// than the environment's STIV_THREADS if that is set, as it is for processes that share a machine (a batch's workers).
/// @throws InputError if STIV_THREADS is not a whole number from 1 up
int usable_processors();

/// Threads that help the calling one with one piece of work after the other: started once, asleep in between, ended
/// with the object. To start them anew for each loop of a call took longer than many loops.
class ThreadPool {
 public:
  /// Fewer, or none, where the system refuses them.
  explicit ThreadPool(int count);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Calls `work` in the calling thread and in those that wake up before it returns there; returns when it has in all
  /// of them. It must not throw, and share out what there is to do by itself. One call at a time.
  void run(const std::function<void()>& work);

 private:
  void wait_for_work();

  std::mutex mutex_;
  std::condition_variable begun_, ended_;
  const std::function<void()>* work_ = nullptr;  // none: what wakes up now comes too late
  std::uint64_t number_ = 0;                     // of the piece of work, so that nobody does one twice
  int busy_ = 0;
  bool closing_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace stiv
