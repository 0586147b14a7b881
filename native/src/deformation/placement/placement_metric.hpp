// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "stiv/deformation/metric.hpp"

namespace stiv {

/// The 3 x 3 block of J'J + damping that belongs to the second control row, at controls p.
using PlacementBlock = std::function<Eigen::Matrix3d(const ControlsView& p)>;

/// Metric of a placement with controls (2, 3): centre, and rotation or scale. Vertices are counted from their mean, so
/// the 6 x 6 matrix J'J falls into two 3 x 3 blocks; that of the centre is n times the unit matrix.
std::unique_ptr<Metric> make_placement_metric(Index vertex_count, PlacementBlock block, const MetricOptions& options);

/// eps times a diagonal of J'J. Entries of directions in which nothing extends (all vertices on a line, or only one)
/// are raised to a trifle of the largest, or to 1 where all vanish: nothing pushes there, so nothing moves there.
Vector3 placement_damping(const Vector3& diagonal, double smoothness);

}  // namespace stiv
