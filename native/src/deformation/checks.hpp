// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/metric.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// @throws InputError unless `p` has one row for each of `count` controls.
void check_control_rows(const Controls& p, Index count);

/// @throws InputError naming the first row of `positions` that is not finite; `what` says what the rows are.
void check_finite(const Positions& positions, const char* what);

/// The weights of `count` controls, all 1 where none are given.
/// @throws InputError: smoothness not in (0, inf), weights of another number, negative or not finite.
Eigen::VectorXd checked_weights(const MetricOptions& options, Index count);

}  // namespace stiv
