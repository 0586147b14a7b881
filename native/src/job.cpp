// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/job.hpp"

#include <chrono>

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
  std::exception_ptr raised;
  try {
    work(execution_);
  } catch (...) {
    raised = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  raised_ = raised;
  progress_.done = true;
  ended_.notify_all();
}

JobProgress JobThread::poll() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

bool JobThread::wait_for(double seconds) const {
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return progress_.done; });
}

void JobThread::wait() const {
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] { return progress_.done; });
}

void JobThread::rethrow() const {
  if (raised_) std::rethrow_exception(raised_);
}

}  // namespace stiv
