// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "deformation/handles/handle_partition.hpp"
#include "deformation/metric/sparse_factor.hpp"
#include "stiv/deformation/linear.hpp"

namespace stiv {

/// M, (n, m), of a handle map without the entries below `negligible` times the largest of their column. Handles that
/// are scattered over a mesh move only their neighborhoods, so few entries remain. Nothing if more than `limit` remain.
/// @param drive (free, m): each handle's contribution to the right-hand side of the factor's equations
std::optional<WeightMatrix> truncated_map(const SparseFactor& factor, const SymmetricMatrix& drive,
                                          const HandlePartition& partition, double negligible, double limit);

/// M'g, without the controls that g does not reach.
SparseField pull_back(const WeightMatrix& map, const SparseField& g);

/// (m) The diagonal of M'M, or of M'G M.
Eigen::VectorXd gram_diagonal(const WeightMatrix& map, const WeightMatrix* surface_gram);

}  // namespace stiv
