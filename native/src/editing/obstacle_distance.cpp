// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>

#include "editing/motion_box.hpp"
#include "editing/near_scene.hpp"
#include "editing/scene_rows.hpp"
#include "stiv/editing/obstacle.hpp"

namespace stiv {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double rounded_up = 1 + 0x1p-40;  // of distances

/// The moving vertex that is closest to a point.
std::optional<Vector3> vertex_near(const Surface& surface, const PositionsView& q, const Vector3& point) {
  std::optional<Vector3> nearest;
  double least = infinity;
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex) {
    if (surface.is_fixed(vertex)) continue;
    const Vector3 position = q.row(vertex);
    const double squared = (position - point).squaredNorm();
    if (squared < least) least = squared, nearest = position;
  }
  return nearest;
}

/// An upper bound of the distance of moving vertices from obstacles: that of two that are each other's closest ones.
double distance_bound(const Surface& surface, const Obstacles& obstacles, const PositionsView& q, const Vector3& from) {
  double bound = infinity;
  for (std::optional<Vector3> vertex = vertex_near(surface, q, from); vertex;) {
    std::optional<Vector3> corner;
    for (const auto& obstacle : obstacles) {
      const double least = corner ? (*corner - *vertex).norm() : bound;
      if (const auto closer = obstacle->corner_near(*vertex, least)) corner = closer;
    }
    if (!corner) break;
    bound = (*corner - *vertex).norm();
    vertex = vertex_near(surface, q, *corner);
  }
  return bound;
}

/// The closest pair with the triangles of obstacles within a distance of a box.
std::optional<NearestTriangles> find_near(const Eigen::AlignedBox3d& box, double distance, const Surface& surface,
                                          const Obstacles& obstacles, const PositionsView& q, DistancePairs pairs,
                                          const Execution& execution) {
  const NearScene scene = near_scene(surface, obstacles, box, {}, execution, distance);
  SceneRows rows(scene.obstacles);
  auto nearest = LeastDistance(scene.surface).find(rows.with_rest(q), pairs);
  if (nearest)
    for (Index& triangle : nearest->triangles) triangle = scene.whole_number(triangle);
  return nearest;
}

}  // namespace

std::optional<NearestTriangles> least_distance(const std::shared_ptr<const Surface>& surface,
                                               const Obstacles& obstacles, const PositionsView& q, DistancePairs pairs,
                                               const Execution& execution) {
  if (obstacles.empty()) return LeastDistance(surface).find(q, pairs);
  const FloatingPointScope floating_point;
  surface->check_positions(q);
  const Eigen::AlignedBox3d bounds = moving_bounds(*surface, q);
  double reach = bounds.isEmpty() ? infinity : rounded_up * distance_bound(*surface, obstacles, q, bounds.center());
  while (reach < infinity) {
    const auto nearest = find_near(bounds, reach, *surface, obstacles, q, pairs, execution);
    if (nearest && nearest->distance <= reach) return nearest;
    reach = nearest ? rounded_up * nearest->distance : infinity;  // the vertices of the bound are of no triangle
  }
  return find_near(whole_space(), 0, *surface, obstacles, q, pairs, execution);
}

}  // namespace stiv
