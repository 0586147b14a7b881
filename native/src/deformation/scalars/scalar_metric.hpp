// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>

#include "stiv/deformation/metric.hpp"

namespace stiv {

/// The metric of scalars, damped relative to its own diagonal. (mathematics.md, "Scalars")
/// @param gram J'GJ, (k, k)
std::unique_ptr<Metric> make_scalar_metric(const Eigen::MatrixXd& gram, const MetricOptions& options);

}  // namespace stiv
