// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mutex>
#include <vector>

#include "deformation/metric/decaying_solver.hpp"
#include "deformation/metric/sparse_factor.hpp"

namespace stiv {

/// Columns of the inverse of a sparse matrix, in groups of sixteen neighbors. A group is computed when it is first
/// needed: contacts need those of the controls near them. Several threads may ask.
class InverseColumns {
 public:
  struct Column {
    std::vector<Index> row;
    std::vector<double> value;
  };

  /// @param matrix the lower triangle, positive definite
  /// @param negligible entries of a column are left out, relative to its largest one; 0: none
  /// @throws InputError if the matrix cannot be factored
  InverseColumns(const SymmetricMatrix& matrix, double negligible);

  const Column& column(Index k) const;

 private:
  void compute(Index group) const;

  SparseFactor factor_;
  mutable std::mutex solving_;
  mutable DecayingSolver solver_;
  mutable std::vector<std::once_flag> computed_;  ///< by group
  mutable std::vector<Column> columns_;
};

}  // namespace stiv
