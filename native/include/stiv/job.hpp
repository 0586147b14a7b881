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
class JobThread {
 public:
  using Work = std::function<void(Execution&)>;

  /// Starts at once. @param threads as Execution
  explicit JobThread(Work work, int threads = 0);
  /// Cancels the work and waits for its end.
  ~JobThread();
  JobThread(const JobThread&) = delete;
  JobThread& operator=(const JobThread&) = delete;

  JobProgress poll() const;
  /// Asks the work to stop, which it does within milliseconds; does not wait for it.
  void cancel() noexcept { execution_.request_cancel(); }
  /// Waits until the work has ended, at most these seconds; returns whether it has.
  bool wait_for(double seconds) const;
  void wait() const;
  /// Rethrows the exception that ended the work, if any. Only when done.
  void rethrow() const;

 private:
  void run(const Work& work);

  Execution execution_;
  mutable std::mutex mutex_;
  mutable std::condition_variable ended_;
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
