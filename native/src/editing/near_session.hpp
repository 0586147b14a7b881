// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <future>
#include <memory>

#include "editing/near_scene.hpp"
#include "editing/session_implementation.hpp"
#include "stiv/execution.hpp"

namespace stiv {

/// The obstacles near a box, and a session with them, which has their positions.
struct NearSession {
  NearScene scene;
  std::unique_ptr<SessionImplementation> session;
};

/// The session in the box that a drag is likely to need next. With several threads, it is made on one of its own while
/// ticks continue, and otherwise when it is taken. Both make the same: what a session finds does not depend on when its
/// trees were built.
class NextSession {
 public:
  using Make = std::function<std::unique_ptr<NearSession>(Execution& execution)>;

  /// @param make is called in another thread if there are several, and again by `take` if that failed; what it refers
  /// to must outlive this object
  NextSession(const Eigen::AlignedBox3d& box, int threads, Make make);
  ~NextSession();
  NextSession(const NextSession&) = delete;
  NextSession& operator=(const NextSession&) = delete;

  const Eigen::AlignedBox3d& box() const { return box_; }
  /// The session, as soon as it is made. If it cannot be made in another thread, it is made in this one.
  /// @throws Interrupted if the call is cancelled; then this may be called again
  std::unique_ptr<NearSession> take(Execution& of_call);

 private:
  Eigen::AlignedBox3d box_;
  Make make_;
  Execution execution_{1};
  std::future<std::unique_ptr<NearSession>> made_;
};

}  // namespace stiv
