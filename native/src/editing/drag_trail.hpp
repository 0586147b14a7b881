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
  Controls start() const { return controls_at(accepted_, 0); }
  /// The accepted controls, from the last to the start.
  std::vector<Controls> way_back() const;
  /// Were all goals close to the straight line from the start to this goal? No control may be a rotation.
  bool is_straight(const Controls& goal, double tolerance) const;

 private:
  // One after another in few arrays: many small ones between those of the calls would fragment the heap.
  using Values = std::vector<double>;

  void free_all();
  std::size_t count_in(const Values& values) const { return values.size() / at(3 * rows_); }
  Eigen::Map<const Controls> controls_at(const Values& values, std::size_t number) const {
    return {values.data() + number * at(3 * rows_), rows_, 3};
  }

  Eigen::Index rows_ = 0;
  Values goals_, accepted_;
};

}  // namespace stiv
