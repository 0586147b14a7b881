// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

using SymmetricMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// Sixteen right sides at once, one a column.
using ColumnBlock = Eigen::Matrix<double, Eigen::Dynamic, 16, Eigen::RowMajor>;

/// L D L' of a symmetric positive definite matrix. The factor does not fit into the processor's cache, so all right
/// sides share one pass over it: three cost as much as one, sixteen twice as much. Each column's result has the
/// same bits in whatever company it is solved for.
class SparseFactor {
 public:
  /// @throws InputError that begins with `what` if the matrix cannot be factored
  SparseFactor(const SymmetricMatrix& matrix, const char* what);

  Index size() const { return static_cast<Index>(factor_.rows()); }
  Index entries() const { return size() == 0 ? 0 : static_cast<Index>(lower().nonZeros()); }  ///< of L
  Positions solve(const Positions& right) const;
  ColumnBlock solve(const ColumnBlock& right) const;

  /// (size) Marks for solutions of which some rows alone are asked: these rows depend on the marked ones, and on no
  /// others. They are the ancestors in the elimination tree. [Gilbert 1994; Davis, Direct Methods, 3.2]
  std::vector<unsigned char> needed_for(const std::vector<Index>& rows) const;

  /// The solution at the rows that `needed` was made for, with the bits of `solve`. Where right sides are zero nearly
  /// everywhere too, little of L is read.
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
