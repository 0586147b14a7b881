// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/drag_trail.hpp"

#include <algorithm>

namespace stiv {

namespace {

constexpr Eigen::Index most_values = Eigen::Index{1} << 23;  // 64 MB

}  // namespace

void DragTrail::begin(const Controls& start) {
  goals_.clear();
  accepted_ = {start};
}

void DragTrail::add(const Controls& goal, const std::vector<Controls>& path) {
  if (accepted_.empty()) return;
  goals_.push_back(goal);
  accepted_.insert(accepted_.end(), path.begin(), path.end());
  if (static_cast<Eigen::Index>(goals_.size() + accepted_.size()) * goal.size() <= most_values) return;
  goals_.clear();
  accepted_.clear();
}

bool DragTrail::is_straight(const Controls& goal, double tolerance) const {
  const Controls way = goal - start();
  const double length = way.squaredNorm();
  return length > 0 && std::all_of(goals_.begin(), goals_.end(), [&](const Controls& passed) {
           const Controls moved = passed - start();
           const double fraction = std::clamp(moved.cwiseProduct(way).sum() / length, 0.0, 1.0);
           return (moved - fraction * way).rowwise().norm().maxCoeff() <= tolerance;
         });
}

}  // namespace stiv
