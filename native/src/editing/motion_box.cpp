// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/motion_box.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace stiv {

namespace {

constexpr std::array margins{1.0, 0.5, 0.25, 0.125};  // in diagonals of the bounds
constexpr double margins_around = 2.25;               // of them on each side if no motion is known
constexpr double margins_aside = 0.25;                // of them beside the motion
constexpr double margins_ahead = 5;                   // more of them along it
constexpr Index few_triangles = 1 << 16;              // near ones, few for a session

}  // namespace

Eigen::AlignedBox3d moving_bounds(const Surface& surface, const PositionsView& q) {
  Eigen::AlignedBox3d bounds;
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (!surface.is_fixed(vertex)) bounds.extend(Vector3(q.row(vertex)));
  return bounds;
}

Eigen::AlignedBox3d box_around(const Eigen::AlignedBox3d& bounds, const Vector3& motion, const Obstacles& obstacles,
                               Index moving_triangles) {
  if (bounds.isEmpty()) return bounds;
  const Index enough = std::max(few_triangles, 2 * moving_triangles);
  Eigen::AlignedBox3d box;
  const double length = motion.norm();
  const Vector3 direction = length > 0 ? Vector3(motion / length) : Vector3(Vector3::Zero());
  for (const double fraction : margins) {
    const double margin = fraction * bounds.diagonal().norm();
    box = grown(bounds, (length > 0 ? margins_aside : margins_around) * margin);
    box.extend(box.translated(margins_ahead * margin * direction));
    Index near = 0;
    for (const auto& obstacle : obstacles) near += obstacle->count_near(box);
    if (near <= enough) break;
  }
  return box;
}

bool contains(const Eigen::AlignedBox3d& box, const Eigen::AlignedBox3d& bounds, double margin) {
  return bounds.isEmpty() || box.contains(grown(bounds, margin));
}

Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& bounds, double margin) {
  const Vector3 by = Vector3::Constant(margin);
  return {bounds.min() - by, bounds.max() + by};
}

Eigen::AlignedBox3d whole_space() {
  const Vector3 far = Vector3::Constant(std::numeric_limits<double>::infinity());
  return {-far, far};
}

}  // namespace stiv
