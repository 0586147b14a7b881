// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "deformation/metric/sparse_factor.hpp"

namespace stiv {

/// Elimination order and factor pattern for symmetric matrices of 3 x 3 blocks with the same pattern.
class BlockPattern {
 public:
  /// @param pattern (n, n), symmetric: an entry for each block
  explicit BlockPattern(const SymmetricMatrix& pattern);

  Index size() const { return static_cast<Index>(place_.size()); }                ///< n
  std::size_t entries() const { return static_cast<std::size_t>(rows_.size()); }  ///< blocks of a matrix, one triangle

  /// Where block (row, column) of a matrix is stored; one past the entries if the transposed block is stored instead.
  std::size_t slot(Index row, Index column) const;

 private:
  friend class BlockFactor;

  std::vector<Index> place_;                // of a row in the order of elimination
  std::vector<Index> starts_, rows_;        // the upper triangle in that order, by columns, diagonal included
  std::vector<Index> parent_;               // in the elimination tree
  std::vector<std::size_t> factor_starts_;  // of the columns of L, without diagonal
};

/// The factorization L D L' of a matrix of 3 x 3 blocks. It reads one index where SparseFactor reads nine. [Davis,
/// Direct Methods, 4.8]
class BlockFactor {
 public:
  using Block = Eigen::Matrix3d;

  /// Nothing if the matrix is not positive definite. @param blocks by slot
  static std::unique_ptr<const BlockFactor> if_definite(const BlockPattern& pattern, const std::vector<Block>& blocks);

  /// (3 n, 16) -> (3 n, 16)
  ColumnBlock solve(const ColumnBlock& right) const;

 private:
  using Tall = Eigen::Matrix<double, 4, 3>;  // a fourth row of zeros, so that columns are whole vectors

  explicit BlockFactor(const BlockPattern& pattern);
  bool eliminate(Index k, const std::vector<Block>& blocks, std::vector<Tall>& work, std::vector<Index>& visited);

  const BlockPattern& pattern_;
  std::vector<Index> rows_;        // of the columns of L
  std::vector<Tall> lower_;        // L without its diagonal
  std::vector<std::size_t> ends_;  // of the columns so far
  std::vector<Block> inverse_;     // D^-1
};

}  // namespace stiv
