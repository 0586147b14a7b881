// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/near_session.hpp"

#include <chrono>
#include <utility>

#include "stiv/error.hpp"
#include "thread_priority.hpp"

namespace stiv {

namespace {

/// Functions of the caller may not run in a thread that nobody waits for.
void refuse_calls(const std::function<void()>& /*call*/) { throw Interrupted("not in this thread"); }

}  // namespace

NextSession::NextSession(const Eigen::AlignedBox3d& box, int threads, Make make) : box_(box), make_(std::move(make)) {
  if (threads == 1) return;
  made_ = std::async(std::launch::async, [this] {
    const FloatingPointScope floating_point;
    lower_thread_priority();
    execution_.set_owner(refuse_calls);
    return make_(execution_);
  });
}

NextSession::~NextSession() {
  execution_.request_cancel();
  if (made_.valid()) made_.wait();
}

std::unique_ptr<NearSession> NextSession::take(Execution& of_call) {
  if (!made_.valid()) return make_(of_call);
  while (made_.wait_for(std::chrono::milliseconds(1)) == std::future_status::timeout) of_call.check();
  try {
    return made_.get();
  } catch (const std::exception&) {
    return make_(of_call);  // finds the reason again, if it still holds
  }
}

}  // namespace stiv
