// SPDX-License-Identifier: GPL-3.0-or-later
#include "helper_threads.hpp"

#include <exception>

namespace stiv {

HelperThreads::HelperThreads(int count) {
  threads_.reserve(static_cast<std::size_t>(count));
  try {
    for (int k = 0; k < count; ++k) threads_.emplace_back([this] { wait_for_work(); });
  } catch (const std::exception&) {
    // Those that there are will do.
  }
}

HelperThreads::~HelperThreads() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  begun_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void HelperThreads::run(const std::function<void()>& work) {
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

void HelperThreads::wait_for_work() {
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
