// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// The goals and the accepted controls of a drag since its start. Forgets them if they take too much memory.
class DragTrail {
 public:
  void begin(const Controls& start);
  void add(const Controls& goal, const std::vector<Controls>& path);

  /// Has the drag a goal, and are all known?
  bool is_known() const { return !goals_.empty(); }
  const Controls& start() const { return accepted_.front(); }
  /// The accepted controls, from the last to the start.
  std::vector<Controls> way_back() const { return {accepted_.rbegin(), accepted_.rend()}; }
  /// Were all goals close to the straight line from the start to this goal? No control may be a rotation.
  bool is_straight(const Controls& goal, double tolerance) const;

 private:
  std::vector<Controls> goals_, accepted_;
};

}  // namespace stiv
