// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/block_factor.hpp"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <algorithm>

namespace stiv {

BlockPattern::BlockPattern(const SymmetricMatrix& pattern) : place_(static_cast<std::size_t>(pattern.cols())) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> order;
  Eigen::AMDOrdering<Index>()(pattern, order);
  for (Index k = 0; k < size(); ++k) place_[at(order.indices()[k])] = k;
  std::vector<std::vector<Index>> columns(at(size()));
  for (Index column = 0; column < pattern.cols(); ++column)
    for (SymmetricMatrix::InnerIterator entry(pattern, column); entry; ++entry)
      if (const Index row = place_[at(static_cast<Index>(entry.row()))]; row <= place_[at(column)])
        columns[at(place_[at(column)])].push_back(row);
  starts_.push_back(0);
  parent_.assign(at(size()), -1);
  std::vector<Index> visited(at(size()), -1);
  std::vector<std::size_t> counts(at(size()), 0);
  for (Index k = 0; k < size(); ++k) {
    std::sort(columns[at(k)].begin(), columns[at(k)].end());
    rows_.insert(rows_.end(), columns[at(k)].begin(), columns[at(k)].end());
    starts_.push_back(static_cast<Index>(rows_.size()));
    visited[at(k)] = k;
    for (Index row : columns[at(k)])
      for (; visited[at(row)] != k; row = parent_[at(row)]) {
        if (parent_[at(row)] < 0) parent_[at(row)] = k;
        ++counts[at(row)];
        visited[at(row)] = k;
      }
  }
  factor_starts_.push_back(0);
  for (const std::size_t count : counts) factor_starts_.push_back(factor_starts_.back() + count);
}

std::size_t BlockPattern::slot(Index row, Index column) const {
  const Index i = place_[at(row)], j = place_[at(column)];
  if (i > j) return entries();
  const auto begin = rows_.begin() + starts_[at(j)], end = rows_.begin() + starts_[at(j) + 1];
  return static_cast<std::size_t>(std::lower_bound(begin, end, i) - rows_.begin());
}

BlockFactor::BlockFactor(const BlockPattern& pattern)
    : pattern_(pattern),
      rows_(pattern.factor_starts_.back()),
      lower_(pattern.factor_starts_.back()),
      ends_(pattern.factor_starts_.begin(), pattern.factor_starts_.end() - 1),
      inverse_(at(pattern.size())) {}

std::unique_ptr<const BlockFactor> BlockFactor::if_definite(const BlockPattern& pattern,
                                                            const std::vector<Block>& blocks) {
  std::unique_ptr<BlockFactor> factor(new BlockFactor(pattern));
  std::vector<Tall> work(at(pattern.size()), Tall::Zero());
  std::vector<Index> visited(at(pattern.size()), -1);
  for (Index k = 0; k < pattern.size(); ++k)
    if (!factor->eliminate(k, blocks, work, visited)) return nullptr;
  return factor;
}

/// Row k of L, from the rows above: L D l_k' = column k of the matrix. `work` is zero before and after.
bool BlockFactor::eliminate(Index k, const std::vector<Block>& blocks, std::vector<Tall>& work,
                            std::vector<Index>& visited) {
  std::vector<Index> reached;
  visited[at(k)] = k;
  for (Index entry = pattern_.starts_[at(k)]; entry < pattern_.starts_[at(k) + 1]; ++entry) {
    const Index row = pattern_.rows_[at(entry)];
    work[at(row)].topRows<3>() = blocks[at(entry)];
    for (Index up = row; visited[at(up)] != k; up = pattern_.parent_[at(up)]) {
      visited[at(up)] = k;
      reached.push_back(up);
    }
  }
  std::sort(reached.begin(), reached.end());
  Block diagonal = work[at(k)].topRows<3>();
  work[at(k)].setZero();
  for (const Index row : reached) {
    const Block solved = work[at(row)].topRows<3>();
    work[at(row)].setZero();
    std::size_t& end = ends_[at(row)];
    for (std::size_t entry = pattern_.factor_starts_[at(row)]; entry < end; ++entry)
      work[at(rows_[entry])].noalias() -= lower_[entry].lazyProduct(solved);
    const Block in_row = solved.transpose() * inverse_[at(row)];
    diagonal -= in_row * solved;
    rows_[end] = k;
    lower_[end].setZero();
    lower_[end++].topRows<3>() = in_row;
  }
  const Eigen::LLT<Block> factor(diagonal);
  inverse_[at(k)] = factor.solve(Block::Identity());
  return factor.info() == Eigen::Success;
}

ColumnBlock BlockFactor::solve(const ColumnBlock& right) const {
  using Rows = Eigen::Matrix<double, 3, 16, Eigen::RowMajor>;
  ColumnBlock x(right.rows(), right.cols());
  const auto rows_at = [](auto& block, Index k) { return block.template middleRows<3>(3 * k); };
  for (Index k = 0; k < pattern_.size(); ++k) rows_at(x, pattern_.place_[at(k)]) = rows_at(right, k);
  for (Index k = 0; k < pattern_.size(); ++k) {
    const Rows known = rows_at(x, k);
    if ((known.array() == 0).all()) continue;
    for (std::size_t entry = pattern_.factor_starts_[at(k)]; entry < ends_[at(k)]; ++entry)
      rows_at(x, rows_[entry]).noalias() -= lower_[entry].topRows<3>().lazyProduct(known);
  }
  for (Index k = pattern_.size() - 1; k >= 0; --k) {
    Rows sum = inverse_[at(k)].lazyProduct(rows_at(x, k));
    for (std::size_t entry = pattern_.factor_starts_[at(k)]; entry < ends_[at(k)]; ++entry)
      sum.noalias() -= lower_[entry].topRows<3>().transpose().lazyProduct(rows_at(x, rows_[entry]));
    rows_at(x, k) = sum;
  }
  ColumnBlock result(right.rows(), right.cols());
  for (Index k = 0; k < pattern_.size(); ++k) rows_at(result, k) = rows_at(x, pattern_.place_[at(k)]);
  return result;
}

}  // namespace stiv
