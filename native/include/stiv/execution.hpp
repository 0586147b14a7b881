// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "stiv/types.hpp"

namespace stiv {

class ThreadPool;

/// Counts of operations, independent of the machine.
struct Counters {
  std::int64_t sub_edits = 0;         ///< passes of the outer loop
  std::int64_t rounds = 0;            ///< detections that were followed by a response
  std::int64_t detections = 0;        ///< traversals of the whole scene
  std::int64_t candidate_pairs = 0;   ///< relevant pairs with overlapping bounds
  std::int64_t pairs_tested = 0;      ///< pairs that reached the iterative narrow phase
  std::int64_t events = 0;            ///< interference events found
  std::int64_t acceptance_tries = 0;  ///< states proposed to the acceptance test
  std::int64_t infeasible = 0;        ///< goals and candidates without a surface (InfeasibleError)
};

/// Wall times in seconds.
struct Timings {
  double deformation = 0;  ///< f(p), J'
  double detection = 0;
  double volumes = 0;
  double response = 0;
  double acceptance = 0;
  double total = 0;
};

/// Where the end of a time budget may interrupt the work.
enum class BudgetEnd {
  anywhere,
  after_checkpoint  ///< not before the first checkpoint: calls that resume each other progress however short their time
};

/// Context of a call: threads, progress, cancellation, counters, timings. One object for each call; only
/// `request_cancel` may be called from another thread.
class Execution {
 public:
  /// @param threads number of threads; 0: one for each processor that the process may use, no more than
  /// the environment's STIV_THREADS.
  explicit Execution(int threads = 0);
  ~Execution();

  int threads() const { return threads_; }

  /// Asks the work to stop; within milliseconds it throws Interrupted.
  void request_cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  /// Lets a predicate cancel the work as well. It is called often, from several threads at once.
  void cancel_when(std::function<bool()> is_cancelled) { is_cancelled_ = std::move(is_cancelled); }
  bool cancel_requested() const {
    return cancelled_.load(std::memory_order_relaxed) || (is_cancelled_ && is_cancelled_());
  }

  /// Stops the work the given number of seconds from now, as if cancelled.
  void set_time_budget(double seconds, BudgetEnd end = BudgetEnd::anywhere);
  bool has_time_budget() const { return deadline_.has_value(); }
  /// The work so far survives the end of the budget. Called outside of for_chunks.
  void checkpoint() noexcept { awaits_checkpoint_ = false; }
  bool budget_used_up() const;

  /// @throws Interrupted when cancelled or over the time budget. Called between iterations and between chunks.
  void check() const;

  /// Called with a phase's name and the fraction done in [0, 1], from the calling thread only.
  void set_progress(std::function<void(const char* phase, double fraction)> report) { progress_ = std::move(report); }
  void report(const char* phase, double fraction) const;

  /// Runs functions of the caller. @see JobThread
  using Owner = std::function<void(const std::function<void()>& call)>;
  /// Runs `call` where the caller's functions may run: in this thread, or for a job in the thread that waits for it.
  /// @throws what `call` throws; Interrupted if a job is cancelled before its call begins
  void call_owner(const std::function<void()>& call) const;
  /// Sets the owner, also of all executions that the current thread makes from now on.
  void set_owner(Owner owner);

  /// Calls `work(begin, end, chunk)` for consecutive chunks of [0, count), on all threads. Chunk boundaries depend on
  /// `count` and `chunk_size` alone, so results collected by chunk number do not depend on the number of threads.
  /// The first exception (lowest chunk) is rethrown in the calling thread after all threads have ended the loop.
  /// The threads are started by the first loop that has work for several, and sleep until the next one. Loops within
  /// the work run on the thread that they are in.
  void for_chunks(Index count, Index chunk_size, const std::function<void(Index, Index, Index)>& work) const;
  static Index chunk_count(Index count, Index chunk_size) { return (count + chunk_size - 1) / chunk_size; }

  Counters counters;
  Timings timings;

 private:
  int threads_;
  std::atomic<bool> cancelled_{false};
  std::function<bool()> is_cancelled_;
  std::optional<std::chrono::steady_clock::time_point> deadline_;
  bool awaits_checkpoint_ = false;
  std::function<void(const char*, double)> progress_;
  Owner owner_;
  mutable std::atomic<bool> in_loop_{false};
  mutable std::unique_ptr<ThreadPool> helpers_;
};

/// Adds the time of a scope to one of the timings.
class ScopedTimer {
 public:
  explicit ScopedTimer(double& seconds) : seconds_(seconds) {}
  ~ScopedTimer() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Round to nearest, denormals kept, for the length of a scope in this thread: another add-on may have changed these
/// settings, and every error bound of this library assumes the default. Each public entry and each worker thread holds
/// one.
class FloatingPointScope {
 public:
  FloatingPointScope();
  ~FloatingPointScope();
  FloatingPointScope(const FloatingPointScope&) = delete;
  FloatingPointScope& operator=(const FloatingPointScope&) = delete;

 private:
  std::uint32_t saved_control_;
  int saved_rounding_;
};

}  // namespace stiv
