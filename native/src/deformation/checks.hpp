// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/metric.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// @throws InputError unless `p` has one row for each of `count` controls.
void check_control_rows(const Controls& p, Index count);

/// @throws InputError naming the first row of `positions` that is not finite; `what` says what the rows are.
void check_finite(const Positions& positions, const char* what);

/// Weights of the response of `count` controls. Where no control's coordinates differ, one column and no axes.
struct ResponseWeights {
  Eigen::MatrixXd values;             ///< (m, 1), or (m, 3)
  std::vector<Eigen::Matrix3d> axes;  ///< (m) rotations whose columns the three weights act along, or empty: x, y, z

  bool are_uniform() const { return values.cols() == 1; }
};

/// The weights of `count` controls, all 1 where none are given.
/// @throws InputError: smoothness not in (0, inf); weights of another number, negative or not finite; axes of another
/// number, or that are no rotation.
ResponseWeights checked_weights(const MetricOptions& options, Index count);

}  // namespace stiv
