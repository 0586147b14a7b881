// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <memory>

#include "stiv/deformation/metric.hpp"

namespace stiv {

/// Weights of controls in vertices by columns: the weights of one control stand together.
using WeightColumns = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// The metric of q = M p + c: M'M of the controls that may respond and move something, with eps times its mean
/// diagonal added to the diagonal. Few controls are solved by an explicit inverse, of which a sparse right-hand side
/// touches few columns; many by a sparse factor. (mathematics.md, "Metric")
std::unique_ptr<Metric> make_linear_metric(const WeightColumns& matrix, const MetricOptions& options);

}  // namespace stiv
