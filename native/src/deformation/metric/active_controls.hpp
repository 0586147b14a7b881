// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// The active controls of a metric, those that may respond and move a vertex, and the roots of their weights.
struct ActiveControls {
  std::vector<Index> control;
  std::vector<double> root_weight;
  std::vector<Index> place;  ///< (m) position of a control among the active ones, or -1
};

/// @param squared_lengths (m) diagonal of J'J; controls with 0 are not active
/// @param weights (m) of the response; controls with 0 are not active
ActiveControls active_controls(const Eigen::VectorXd& squared_lengths, const Eigen::VectorXd& weights);

/// A sparse covector over the active controls, times W^1/2.
struct ActiveVector {
  std::vector<Index> place;
  std::vector<Vector3> value;
};

ActiveVector restrict_to(const ActiveControls& active, const SparseField& g);

using ActiveColumns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// The same as a dense matrix, (active, 3).
ActiveColumns dense_columns(const ActiveControls& active, const ActiveVector& vector);

/// W^1/2 times values over the active controls, as a field over all controls.
SparseField extend_from(const ActiveControls& active, const ActiveColumns& values);

}  // namespace stiv
