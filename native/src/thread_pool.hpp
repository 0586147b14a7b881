// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace stiv {

/// The default number of threads: one for each processor that this process may use, at most the environment variable
/// STIV_THREADS. Processes that share a machine, such as the workers of a batch, set it.
/// @throws InputError if STIV_THREADS is not a positive integer
int usable_processors();

/// Threads that help the calling thread, started once: starting them takes longer than many loops. They await the next
/// loop awake, and fall asleep if it does not begin soon; with fewer processors than threads, at once.
class ThreadPool {
 public:
  /// Starts fewer threads, or none, if the system refuses them.
  explicit ThreadPool(int count);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Calls `work(thread)` in the calling thread, number 0, and in the threads that come before it ends there; returns
  /// when all have ended. It must not throw, and distributes its chunks itself. One call at a time.
  void run(const std::function<void(int thread)>& work);

 private:
  void wait_for_work(int thread);

  bool polls_;  // each thread has a processor: none takes the time of another
  std::mutex mutex_;
  std::condition_variable begun_, ended_;
  const std::function<void(int)>* work_ = nullptr;  // null: no work is open
  // The mutex is held while these change. Threads that poll read them without it.
  std::atomic<std::uint64_t> number_ = 0;  // of the work, so that no thread does it twice
  std::atomic<int> busy_ = 0;
  bool closing_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace stiv
