// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <memory>

#include "stiv/deformation/metric.hpp"

namespace stiv {

/// Weights of controls at vertices, stored by controls.
using WeightColumns = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// The metric of q = M p + c: M'M of the active controls, damped by eps times its mean diagonal. For few controls it
/// stores the inverse, of which a sparse right-hand side reads few columns; for many, a sparse factor. (mathematics.md,
/// "Metric")
std::unique_ptr<Metric> make_linear_metric(const WeightColumns& matrix, const MetricOptions& options);

}  // namespace stiv
