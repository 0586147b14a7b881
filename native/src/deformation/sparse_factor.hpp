// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCholesky>

#include "stiv/types.hpp"

namespace stiv {

using SymmetricMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// Sixteen right sides at once, one a column.
using ColumnBlock = Eigen::Matrix<double, Eigen::Dynamic, 16, Eigen::RowMajor>;

/// L D L' of a symmetric positive definite matrix. The factor does not fit into the processor's cache, so all right
/// sides take part in one pass over it: three cost as much as one, sixteen twice as much. Each column's result has the
/// same bits in whatever company it is solved for.
class SparseFactor {
 public:
  /// @throws InputError that begins with `what` if the matrix cannot be factored
  SparseFactor(const SymmetricMatrix& matrix, const char* what);

  Index size() const { return static_cast<Index>(factor_.rows()); }
  Index entries() const { return size() == 0 ? 0 : static_cast<Index>(lower().nonZeros()); }  ///< of L
  Positions solve(const Positions& right) const;
  ColumnBlock solve(const ColumnBlock& right) const;

 private:
  const SymmetricMatrix& lower() const { return factor_.matrixL().nestedExpression(); }
  template <class Block>
  Block solve_block(const Block& right) const;

  Eigen::SimplicialLDLT<SymmetricMatrix> factor_;
};

}  // namespace stiv
