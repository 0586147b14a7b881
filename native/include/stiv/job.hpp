// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "stiv/execution.hpp"

namespace stiv {

/// The progress of a job.
struct JobProgress {
  const char* phase = "";  ///< as reported to Execution; a literal
  double fraction = 0;     ///< of the phase, in [0, 1]
  bool done = false;       ///< the result is there, or the exception that ended the work
};

/// Runs work on a thread of its own. All members may be called from any other thread.
/// Functions of the caller (Execution::call_owner), such as those of observed deformations, run in the thread that
/// calls poll, wait_for or wait, one at a time. Until then the work waits. Their exceptions end the work.
class JobThread {
 public:
  using Work = std::function<void(Execution&)>;

  /// Starts at once. @param threads as Execution
  explicit JobThread(Work work, int threads = 0);
  /// Cancels the work and waits for its end.
  ~JobThread();
  JobThread(const JobThread&) = delete;
  JobThread& operator=(const JobThread&) = delete;

  /// Makes one call that the work waits for, if any.
  JobProgress poll();
  /// Asks the work to stop, which it does within milliseconds; does not wait for it.
  void cancel() noexcept;
  /// Makes the calls of the work until it has ended, for at most these seconds; returns whether it has.
  bool wait_for(double seconds);
  void wait();
  /// Rethrows the exception that ended the work, if any. Only when done.
  void rethrow() const;

 private:
  /// @cond
  /// A function of the caller that the work waits for.
  struct Call {
    const std::function<void()>& function;
    bool has_begun = false, has_ended = false;
    std::exception_ptr raised = nullptr;
  };
  /// @endcond

  void run(const Work& work);
  void call_owner(const std::function<void()>& function);
  bool has_waiting_call() const;
  void make_call(std::unique_lock<std::mutex>& lock);

  Execution execution_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Call* call_ = nullptr;
  JobProgress progress_;
  std::exception_ptr raised_;
  std::thread thread_;
};

/// A call of the core on a thread of its own: start, poll, cancel, result. It solves exactly as the synchronous call.
/// Until the job is done, nothing else may use the session.
///
///     Job<EditResult> job([&](Execution& execution) { return session.edit(goal, execution); });
///     while (!job.wait_for(0.02)) show(job.poll());
///     const EditResult& result = job.result();
template <class Result>
class Job {
 public:
  /// Starts at once. @param threads as Execution
  explicit Job(std::function<Result(Execution&)> work, int threads = 0)
      : result_(std::make_unique<std::optional<Result>>()),
        thread_(std::make_unique<JobThread>(
            [work = std::move(work), &result = *result_](Execution& execution) { result.emplace(work(execution)); },
            threads)) {}

  JobProgress poll() const { return thread_->poll(); }
  /// Asks the work to stop: a session then returns with the status cancelled; other work throws Interrupted.
  void cancel() noexcept { thread_->cancel(); }
  bool wait_for(double seconds) const { return thread_->wait_for(seconds); }

  /// Waits for the result. @throws what the work threw
  const Result& result() const {
    thread_->wait();
    thread_->rethrow();
    return result_->value();
  }

 private:
  std::unique_ptr<std::optional<Result>> result_;  // outlives the thread
  std::unique_ptr<JobThread> thread_;
};

}  // namespace stiv
