// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// The controls that a metric acts on, those that may respond and move something, and the root of the weight of each.
struct ActiveControls {
  std::vector<Index> control;
  std::vector<double> root_weight;
  std::vector<Index> place;  ///< by control: its place among the active, or -1
};

/// @param squared_lengths (m) diagonal of J'J: how much each control moves; those of 0 are not active
/// @param weights (m) of the response; those of 0 are not active
ActiveControls active_controls(const Eigen::VectorXd& squared_lengths, const Eigen::VectorXd& weights);

/// Values over the active controls, W^1/2 applied, from a covector over all; which of them are not zero.
struct ActiveVector {
  std::vector<Index> place;
  std::vector<Vector3> value;
};

ActiveVector restrict_to(const ActiveControls& active, const SparseField& g);

using ActiveColumns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// The same as a dense matrix, one row for each active control.
ActiveColumns dense_columns(const ActiveControls& active, const ActiveVector& vector);

/// W^1/2 times values over the active controls, as a field over all.
SparseField extend_from(const ActiveControls& active, const ActiveColumns& values);

}  // namespace stiv
