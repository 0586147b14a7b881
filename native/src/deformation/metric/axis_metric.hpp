// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "deformation/checks.hpp"

namespace stiv {

/// Makes the metric for one weight for each control, (m).
using MetricOfWeights = std::function<std::unique_ptr<Metric>(const Eigen::VectorXd& weights)>;

/// A metric with weights for each axis, for a J'J that is the same for x, y and z and couples none of them. Axes with
/// equal weights share an inverse. For uniform weights it is the metric of `of_weights`.
/// Axes other than x, y and z are exact if coupled controls have the same axes.
std::unique_ptr<Metric> make_axis_metric(ResponseWeights weights, const MetricOfWeights& of_weights);

}  // namespace stiv
