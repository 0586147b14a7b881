// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "deformation/metric/active_controls.hpp"

namespace stiv {

/// A matrix for repeated linear combinations of few columns.
class SummedColumns {
 public:
  explicit SummedColumns(const Eigen::MatrixXd& matrix);

  /// sum_k column[k] value[k]', (rows, 3), in the order given, none fused: same bits for any vector width.
  ActiveColumns sum(const std::vector<Index>& columns, const std::vector<Vector3>& values) const;

 private:
  Eigen::Index rows_;
  Eigen::MatrixXd padded_;  ///< padded with zero rows to a whole number of tiles
};

}  // namespace stiv
