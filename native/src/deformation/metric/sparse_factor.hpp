// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

using SymmetricMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// Sixteen right-hand sides, one in each column.
using ColumnBlock = Eigen::Matrix<double, Eigen::Dynamic, 16, Eigen::RowMajor>;

/// L D L' of a symmetric positive definite matrix. The factor does not fit into the processor's cache, so all
/// right-hand sides share one pass over it. Three cost as much as one, sixteen twice as much. The bits of a column's
/// result do not depend on the other columns.
class SparseFactor {
 public:
  /// @throws InputError with this message if the matrix cannot be factored
  SparseFactor(const SymmetricMatrix& matrix, const char* message);

  Index size() const { return static_cast<Index>(factor_.rows()); }
  Index entries() const { return size() == 0 ? 0 : static_cast<Index>(lower().nonZeros()); }  ///< of L
  Positions solve(const Positions& right) const;
  ColumnBlock solve(const ColumnBlock& right) const;

  /// (size) Marks the rows on which the given rows of a solution depend: their ancestors in the elimination tree.
  /// [Gilbert 1994; Davis, Direct Methods, 3.2]
  std::vector<unsigned char> needed_for(const std::vector<Index>& rows) const;

  /// The solution at the rows that `needed` was made for, with the bits of `solve`. If the right-hand sides are zero
  /// nearly everywhere too, little of L is read.
  Positions solve(const Positions& right, const std::vector<unsigned char>& needed) const;
  ColumnBlock solve(const ColumnBlock& right, const std::vector<unsigned char>& needed) const;

  // The factor itself: L without its diagonal, by columns, and where the rows of the matrix are in it.
  const SymmetricMatrix& lower() const { return factor_.matrixL().nestedExpression(); }
  Eigen::VectorXd pivots() const { return factor_.vectorD(); }
  Index place(Index row) const { return factor_.permutationP().indices()[row]; }
  Index row(Index place) const { return factor_.permutationPinv().indices()[place]; }
  Index parent(Index column) const;  ///< in the elimination tree, or -1

 private:
  bool factor(const SymmetricMatrix& matrix);
  template <class Block>
  Block solve_block(const Block& right, const std::vector<unsigned char>* needed) const;

  Eigen::SimplicialLDLT<SymmetricMatrix> factor_;
};

}  // namespace stiv
