// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/block_factor.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <random>

using namespace stiv;

namespace {

/// A symmetric matrix of blocks on a ring with chords, positive definite but for `shift`.
Eigen::MatrixXd random_matrix(Index size, double shift) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * size, 3 * size);
  for (Index row = 0; row < size; ++row)
    for (const Index column : {(row + 1) % size, (row + 2) % size, (5 * row + 3) % size}) {
      if (row == column) continue;
      const Eigen::Matrix3d block = Eigen::Matrix3d::NullaryExpr([&] { return number(random); });
      matrix.block<3, 3>(3 * row, 3 * column) += block;
      matrix.block<3, 3>(3 * column, 3 * row) += block.transpose();
    }
  const double bound = matrix.cwiseAbs().rowwise().sum().maxCoeff();
  matrix.diagonal().array() += bound - shift;
  return matrix;
}

BlockPattern pattern_of(const Eigen::MatrixXd& matrix) {
  const auto size = static_cast<Index>(matrix.rows() / 3);
  SymmetricMatrix pattern(size, size);
  for (Index row = 0; row < size; ++row)
    for (Index column = 0; column < size; ++column)
      if (!matrix.block<3, 3>(3 * row, 3 * column).isZero(0)) pattern.insert(row, column) = 1;
  return BlockPattern(pattern);
}

std::vector<Eigen::Matrix3d> blocks_of(const Eigen::MatrixXd& matrix, const BlockPattern& pattern) {
  std::vector<Eigen::Matrix3d> blocks(pattern.entries() + 1, Eigen::Matrix3d::Zero());
  for (Index row = 0; row < pattern.size(); ++row)
    for (Index column = 0; column < pattern.size(); ++column)
      if (!matrix.block<3, 3>(3 * row, 3 * column).isZero(0))
        blocks[pattern.slot(row, column)] = matrix.block<3, 3>(3 * row, 3 * column);
  return blocks;
}

}  // namespace

TEST_CASE("block factor: solves what a dense factor solves") {
  for (const Index size : {1, 4, 60}) {
    const Eigen::MatrixXd matrix = random_matrix(size, -1);
    const BlockPattern pattern = pattern_of(matrix);
    const auto factor = BlockFactor::if_definite(pattern, blocks_of(matrix, pattern));
    REQUIRE(factor);
    ColumnBlock right = ColumnBlock::Random(3 * size, 16);
    right.col(2).setZero();
    const Eigen::MatrixXd expected = matrix.fullPivLu().solve(Eigen::MatrixXd(right));
    CHECK((Eigen::MatrixXd(factor->solve(right)) - expected).norm() < 1e-12 * expected.norm());
  }
}

TEST_CASE("block factor: a matrix that is not positive definite has none") {
  const Eigen::MatrixXd matrix = random_matrix(60, 1000);
  const BlockPattern pattern = pattern_of(matrix);
  CHECK_FALSE(BlockFactor::if_definite(pattern, blocks_of(matrix, pattern)));
}
