// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "deformation/checks.hpp"

namespace stiv {

/// The metric for one weight a control, (m).
using MetricOfWeights = std::function<std::unique_ptr<Metric>(const Eigen::VectorXd& weights)>;

/// A metric whose J'J couples no axis with another and is the same for x, y and z, with weights for each axis: axes
/// whose weights are equal share one inverse. Uniform weights give `of_weights` itself.
/// Axes other than x, y and z are exact where controls that J'J couples have the same ones.
std::unique_ptr<Metric> make_axis_metric(ResponseWeights weights, const MetricOfWeights& of_weights);

}  // namespace stiv
