// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/sparse_factor.hpp"

#include <string>

#include "stiv/error.hpp"

namespace stiv {

SparseFactor::SparseFactor(const SymmetricMatrix& matrix, const char* what) {
  if (matrix.rows() == 0) return;
  factor_.compute(matrix);
  if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0))
    throw InputError(std::string(what) +
                     ": the equations cannot be factored; the mesh is too long for so few handles, "
                     "or its weights are too different: add handles or fixed vertices");
}

/// P'L'^-1 D^-1 L^-1 P b, with the strict lower triangle of L stored by columns.
template <class Block>
Block SparseFactor::solve_block(const Block& right) const {
  using Row = Eigen::Matrix<double, 1, Block::ColsAtCompileTime>;
  if (right.rows() == 0) return right;
  const SymmetricMatrix& lower = this->lower();
  const auto& place = factor_.permutationP().indices();
  const auto diagonal = factor_.vectorD();
  Block x(right.rows(), right.cols());
  for (Index row = 0; row < size(); ++row) x.row(place[row]) = right.row(row);
  for (Index column = 0; column < size(); ++column) {
    const Row known = x.row(column);
    for (SymmetricMatrix::InnerIterator entry(lower, column); entry; ++entry)
      x.row(entry.row()) -= entry.value() * known;
  }
  for (Index column = size() - 1; column >= 0; --column) {
    Row sum = x.row(column) / diagonal[column];
    for (SymmetricMatrix::InnerIterator entry(lower, column); entry; ++entry) sum -= entry.value() * x.row(entry.row());
    x.row(column) = sum;
  }
  Block result(right.rows(), right.cols());
  for (Index row = 0; row < size(); ++row) result.row(row) = x.row(place[row]);
  return result;
}

Positions SparseFactor::solve(const Positions& right) const { return solve_block(right); }
ColumnBlock SparseFactor::solve(const ColumnBlock& right) const { return solve_block(right); }

}  // namespace stiv
