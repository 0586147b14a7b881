// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "deformation/metric/active_controls.hpp"
#include "deformation/metric/sparse_factor.hpp"
#include "stiv/deformation/metric.hpp"

namespace stiv {

/// Number of controls up to which the inverse is stored: a few MB, of which a sparse right-hand side reads few columns.
constexpr Index full_inverse_limit = 600;

/// The metric of a given J'J, (a, a) over the active controls, damped by eps times its mean diagonal.
std::unique_ptr<Metric> make_gram_metric(Eigen::MatrixXd gram, double smoothness, ActiveControls active);

/// J'J X for X (m, 16) over all controls.
using GramProduct = std::function<ColumnBlock(const ColumnBlock&)>;

/// The metric of a J'J known only by its products: the Nystrom approximation from `rank` probes [Halko, Martinsson,
/// Tropp 2011, 5.5], and on its orthogonal complement the mean of the remaining trace.
/// @param rank multiple of 16
std::unique_ptr<Metric> make_low_rank_metric(const GramProduct& gram, Index rank, double smoothness,
                                             ActiveControls active);

/// J'J replaced by its diagonal, where each control moves mainly a region of its own.
/// @param diagonal (m) of J'J, of all controls
std::unique_ptr<Metric> make_diagonal_metric(const Eigen::VectorXd& diagonal, double smoothness,
                                             const ActiveControls& active);

}  // namespace stiv
