// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/job.hpp"

#include <chrono>

#include "stiv/error.hpp"

namespace stiv {

JobThread::JobThread(Work work, int threads) : execution_(threads) {
  execution_.set_progress([this](const char* phase, double fraction) {
    const std::lock_guard lock(mutex_);
    progress_ = {phase, fraction, false};
  });
  thread_ = std::thread([this, work = std::move(work)] { run(work); });
}

JobThread::~JobThread() {
  cancel();
  thread_.join();
}

void JobThread::run(const Work& work) {
  execution_.set_owner([this](const std::function<void()>& function) { call_owner(function); });
  std::exception_ptr raised;
  try {
    work(execution_);
  } catch (...) {
    raised = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  raised_ = raised;
  progress_.done = true;
  changed_.notify_all();
}

/// Posts a call and waits for its end; a call that has not begun is withdrawn when the job is cancelled.
void JobThread::call_owner(const std::function<void()>& function) {
  Call call{function};
  std::unique_lock lock(mutex_);
  const auto cancelled = [this] { return execution_.cancel_requested(); };
  changed_.wait(lock, [&] { return call_ == nullptr || cancelled(); });
  if (cancelled()) throw Interrupted("cancelled");
  call_ = &call;
  changed_.notify_all();
  changed_.wait(lock, [&] { return call.has_ended || (cancelled() && !call.has_begun); });
  call_ = nullptr;
  changed_.notify_all();
  if (!call.has_ended) throw Interrupted("cancelled");
  if (call.raised) std::rethrow_exception(call.raised);
}

/// A call of cancelled work is withdrawn, even if its thread has not noticed yet.
bool JobThread::has_waiting_call() const {
  return call_ != nullptr && !call_->has_begun && !execution_.cancel_requested();
}

/// Makes the waiting call. The work keeps it alive until it has ended.
void JobThread::make_call(std::unique_lock<std::mutex>& lock) {
  Call& call = *call_;
  call.has_begun = true;
  lock.unlock();
  std::exception_ptr raised;
  try {
    call.function();
  } catch (...) {
    raised = std::current_exception();
  }
  lock.lock();
  call.raised = raised;
  call.has_ended = true;
  changed_.notify_all();
}

void JobThread::cancel() noexcept {
  const std::lock_guard lock(mutex_);  // or a call that is just posted would miss it
  execution_.request_cancel();
  changed_.notify_all();
}

JobProgress JobThread::poll() {
  std::unique_lock lock(mutex_);
  if (has_waiting_call()) make_call(lock);
  return progress_;
}

bool JobThread::wait_for(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  std::unique_lock lock(mutex_);
  const auto has_changed = [this] { return progress_.done || has_waiting_call(); };
  while (changed_.wait_until(lock, end, has_changed) && !progress_.done) {
    make_call(lock);
    if (Clock::now() >= end) break;
  }
  return progress_.done;
}

void JobThread::wait() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return progress_.done || has_waiting_call(); });
    if (progress_.done) return;
    make_call(lock);
  }
}

void JobThread::rethrow() const {
  if (raised_) std::rethrow_exception(raised_);
}

}  // namespace stiv
