// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "stiv/deformation/metric.hpp"

namespace stiv {

/// The (3, 3) block of J'J + damping of the second control row, at controls p.
using PlacementBlock = std::function<Eigen::Matrix3d(const ControlsView& p)>;

/// Metric of a placement with controls (2, 3): center, and rotation or scale. Vertices are relative to their mean, so
/// J'J, (6, 6), has two diagonal blocks; that of the center is n times the identity.
std::unique_ptr<Metric> make_placement_metric(Index vertex_count, PlacementBlock block, const MetricOptions& options);

/// eps times a diagonal of J'J. Entries that vanish (all vertices on a line, or a single one) are raised to a small
/// fraction of the largest, or to 1: no force acts in these directions, so nothing moves.
Vector3 placement_damping(const Vector3& diagonal, double smoothness);

}  // namespace stiv
