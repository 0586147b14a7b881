// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/volumes/stiv.hpp"

#include <algorithm>
#include <cmath>

#include "volumes/gathering.hpp"

namespace stiv {

namespace {

/// A pair may have slid on by the end of the step, so that its frozen plane (n, w) is no longer violated although the
/// pair still met on the way. Such a region keeps this fraction of its target as violation, or it would weigh against
/// its neighbours and V could vanish while events remain. (mathematics.md, Eq. 2)
constexpr double least_violation = 1e-3;

/// What the response may push a pair beyond its threshold is a part of what it went below it, but no less than a part
/// of the region's size, nor than what detection and rounding leave open. A separation that is small beside the mesh is
/// passed by half of it; one that is large beside mesh and motion throws nothing back. (mathematics.md, "Separation")
constexpr double ease_of_depth = 0.1, ease_of_size = 0.02, ease_of_threshold = 2e-3;

/// The distance that the response aims for: that at the start, up to twice the threshold, if it is more.
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
  StivGathering gathering(labels);
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
  const Index count = static_cast<Index>((areas.array() > 0).count());
  const double substitute = count > 0 ? areas.sum() / count : 1;
  for (double& area : areas)
    if (!(area > 0)) area = substitute;
  return areas;
}

}  // namespace stiv
