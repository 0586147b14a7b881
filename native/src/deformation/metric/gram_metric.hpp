// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "deformation/metric/active_controls.hpp"
#include "deformation/metric/sparse_factor.hpp"
#include "stiv/deformation/metric.hpp"

namespace stiv {

/// Up to so many controls the inverse is kept in full: a few MB, and a sparse right side touches few of its columns.
constexpr Index full_inverse_limit = 600;

/// The metric whose J'J, (a, a) over the active controls, is given in full; eps times its mean diagonal is added.
std::unique_ptr<Metric> make_gram_metric(Eigen::MatrixXd gram, double smoothness, ActiveControls active);

/// J'J X for X (m, 16) over all controls.
using GramProduct = std::function<ColumnBlock(const ColumnBlock&)>;

/// The metric whose J'J is known by its products alone: its part in the space of `rank` probes (Nystrom approximation
/// [Halko, Martinsson, Tropp 2011, 5.5]), and on the rest of the space the mean of what is left of its trace.
/// @param rank multiple of 16
std::unique_ptr<Metric> make_low_rank_metric(const GramProduct& gram, Index rank, double smoothness,
                                             ActiveControls active);

/// J'J replaced by its diagonal, where each control moves mainly a region of its own.
/// @param diagonal (m) of J'J, of all controls
std::unique_ptr<Metric> make_diagonal_metric(const Eigen::VectorXd& diagonal, double smoothness,
                                             const ActiveControls& active);

}  // namespace stiv
