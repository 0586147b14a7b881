// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/volumes/relative.hpp"

#include <algorithm>
#include <cmath>

#include "volumes/stiv_sums.hpp"

namespace stiv {

namespace {

/// Least violation of a region, as a fraction of its target. If a pair slides on before the end of the step, its frozen
/// plane (n, w) may no longer be violated. Without this bound the region would cancel its neighbors, and V could
/// vanish while events remain. (mathematics.md, Eq. 2)
constexpr double least_violation = 1e-3;

/// How far the response pushes a pair beyond its threshold: a fraction of its violation, at least a fraction of the
/// region's size and the tolerance of detection. A separation small relative to the mesh is exceeded by half; one large
/// relative to mesh and motion is hardly exceeded. (mathematics.md, "Separation")
constexpr double ease_of_depth = 0.1, ease_of_size = 0.02, ease_of_threshold = 2e-3;

/// The target distance: that at the start, at most twice the threshold, if it is larger than the threshold.
double target_distance(const Event& event, double at_end, double area) {
  const auto& [threshold, most] = event.clearance;
  const double ease =
      std::max({ease_of_depth * (threshold - at_end), ease_of_size * std::sqrt(area), ease_of_threshold * threshold});
  return std::max(std::min(event.start_distance, 2 * threshold), threshold + std::min(ease, most));
}

/// A_i (n . sum_k w_k q1_k - target), Eq. 2.
double region_volume(const Event& event, const Positions& end, double area) {
  const double at_end = event.normal.dot(weighted_sum(event, end)), target = target_distance(event, at_end, area);
  const double approach = at_end - target;
  return area * std::min(approach, -least_violation * target);
}

}  // namespace

std::vector<Stiv> interference_volumes(const Events& events, const std::vector<Region>& regions,
                                       const std::vector<Index>& labels, const Positions& end,
                                       const Eigen::VectorXd& areas) {
  StivSums gathering(labels);
  for (std::size_t k = 0; k < regions.size(); ++k) {
    const Event& event = events[regions[k].event];
    const double area = areas[regions[k].vertex];
    gathering.add_volume(labels[k], region_volume(event, end, area));
    for (int corner = 0; corner < 4; ++corner)  // Eq. 3
      gathering.add_gradient(labels[k], event.vertices[corner], area * event.weights[corner] * event.normal);
  }
  return gathering.stivs();
}

Eigen::VectorXd region_areas(const Surface& surface, const Positions& q) {
  Eigen::VectorXd areas = surface.vertex_areas(q);
  substitute_missing_areas(areas);
  return areas;
}

void substitute_missing_areas(Eigen::VectorXd& areas) {
  const Index count = static_cast<Index>((areas.array() > 0).count());
  const double substitute = count > 0 ? areas.sum() / count : 1;
  for (double& area : areas)
    if (!(area > 0)) area = substitute;
}

}  // namespace stiv
