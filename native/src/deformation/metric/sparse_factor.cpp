// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/metric/sparse_factor.hpp"

#include "stiv/error.hpp"

namespace stiv {

bool SparseFactor::factor(const SymmetricMatrix& matrix) {
  if (matrix.rows() == 0) return true;
  factor_.compute(matrix);
  return factor_.info() == Eigen::Success && factor_.vectorD().minCoeff() > 0;
}

SparseFactor::SparseFactor(const SymmetricMatrix& matrix, const char* message) {
  if (!factor(matrix)) throw InputError(message);
}

Index SparseFactor::parent(Index column) const {
  const SymmetricMatrix::InnerIterator first(lower(), column);  // the first entry below the diagonal
  return first ? static_cast<Index>(first.row()) : -1;
}

std::vector<unsigned char> SparseFactor::needed_for(const std::vector<Index>& rows) const {
  std::vector<unsigned char> needed(static_cast<std::size_t>(size()), 0);
  for (const Index row : rows) {
    for (Index column = place(row); column >= 0; column = parent(column)) {
      if (needed[at(column)] != 0) break;
      needed[at(column)] = 1;
    }
  }
  return needed;
}

/// P'L'^-1 D^-1 L^-1 P b, with the strict lower triangle of L stored by columns.
template <class Block>
Block SparseFactor::solve_block(const Block& right, const std::vector<unsigned char>* needed) const {
  using Row = Eigen::Matrix<double, 1, Block::ColsAtCompileTime>;
  if (right.rows() == 0) return right;
  const SymmetricMatrix& lower = this->lower();
  const auto& place = factor_.permutationP().indices();
  const auto diagonal = factor_.vectorD();
  Block x(right.rows(), right.cols());
  for (Index row = 0; row < size(); ++row) x.row(place[row]) = right.row(row);
  for (Index column = 0; column < size(); ++column) {
    const Row known = x.row(column);
    if ((known.array() == 0).all()) continue;
    for (SymmetricMatrix::InnerIterator entry(lower, column); entry; ++entry)
      x.row(entry.row()) -= entry.value() * known;
  }
  for (Index column = size() - 1; column >= 0; --column) {
    if (needed != nullptr && (*needed)[at(column)] == 0) continue;
    Row sum = x.row(column) / diagonal[column];
    for (SymmetricMatrix::InnerIterator entry(lower, column); entry; ++entry) sum -= entry.value() * x.row(entry.row());
    x.row(column) = sum;
  }
  Block result(right.rows(), right.cols());
  for (Index row = 0; row < size(); ++row) result.row(row) = x.row(place[row]);
  return result;
}

Positions SparseFactor::solve(const Positions& right) const { return solve_block(right, nullptr); }
ColumnBlock SparseFactor::solve(const ColumnBlock& right) const { return solve_block(right, nullptr); }
Positions SparseFactor::solve(const Positions& right, const std::vector<unsigned char>& needed) const {
  return solve_block(right, &needed);
}
ColumnBlock SparseFactor::solve(const ColumnBlock& right, const std::vector<unsigned char>& needed) const {
  return solve_block(right, &needed);
}

}  // namespace stiv
