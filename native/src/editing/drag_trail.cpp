// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/drag_trail.hpp"

#include <algorithm>

namespace stiv {

namespace {

constexpr std::size_t most_values = std::size_t{1} << 23;  // 64 MB

void append(std::vector<double>& values, const Controls& controls) {
  values.insert(values.end(), controls.data(), controls.data() + controls.size());
}

}  // namespace

void DragTrail::begin(const Controls& start) {
  rows_ = start.rows();
  free_all();
  append(accepted_, start);
}

void DragTrail::add(const Controls& goal, const std::vector<Controls>& path) {
  if (accepted_.empty()) return;
  append(goals_, goal);
  for (const Controls& controls : path) append(accepted_, controls);
  if (goals_.size() + accepted_.size() <= most_values) return;
  free_all();
}

void DragTrail::free_all() {
  goals_ = Values();
  accepted_ = Values();
}

std::vector<Controls> DragTrail::way_back() const {
  std::vector<Controls> way;
  for (std::size_t number = count_in(accepted_); number-- > 0;) way.emplace_back(controls_at(accepted_, number));
  return way;
}

bool DragTrail::is_straight(const Controls& goal, double tolerance) const {
  const Controls begin = start(), way = goal - begin;
  const double length = way.squaredNorm();
  if (!(length > 0)) return false;
  for (std::size_t number = 0; number < count_in(goals_); ++number) {
    const Controls moved = controls_at(goals_, number) - begin;
    const double fraction = std::clamp(moved.cwiseProduct(way).sum() / length, 0.0, 1.0);
    if (!((moved - fraction * way).rowwise().norm().maxCoeff() <= tolerance)) return false;
  }
  return true;
}

}  // namespace stiv
