// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/metric.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// @throws InputError unless p has `count` rows
void check_control_rows(const Controls& p, Index count);

/// @throws InputError naming the first row that is not finite
/// @param what names a row in the message
void check_finite(const Positions& positions, const char* what);

/// Response weights of all controls. One column and no axes if the weights of every control are equal.
struct ResponseWeights {
  Eigen::MatrixXd values;             ///< (m, 1), or (m, 3)
  std::vector<Eigen::Matrix3d> axes;  ///< (m) rotations whose columns are the directions of the weights; empty: x, y, z

  bool are_uniform() const { return values.cols() == 1; }
};

/// The weights of `count` controls, by default all 1.
/// @throws InputError if smoothness is not in (0, inf), or the number or values of weights or axes are invalid
ResponseWeights checked_weights(const MetricOptions& options, Index count);

}  // namespace stiv
