// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "deformation/metric/sparse_factor.hpp"

namespace stiv {

/// Some rows of a `ColumnBlock`.
struct BlockRow {
  Index row = 0;
  Eigen::Array<double, 1, ColumnBlock::ColsAtCompileTime> values;
};

/// Solves for sparse right-hand sides whose solutions decay away from them, and leaves out negligible rows. The
/// solution in a subtree of the elimination tree depends on its right-hand side and on the rows that border it. A
/// subtree with a zero right-hand side is skipped if all of these rows are negligible, so little of L is read.
class DecayingSolver {
 public:
  /// @param negligible relative to the largest entry of a column of the solution
  DecayingSolver(const SparseFactor& factor, double negligible);

  /// The rows of the solutions with entries that are not negligible; the other entries of these rows are 0.
  /// @param right rows of sixteen right-hand sides that are close to each other; repeated rows add up
  std::vector<BlockRow> solve(const std::vector<BlockRow>& right);

 private:
  using Row = Eigen::Array<double, 1, ColumnBlock::ColsAtCompileTime>;

  void add_to_path(const BlockRow& right);
  void substitute_forward();
  void substitute_backward(Index column);
  Row solve_path();
  bool borders_something(Index column) const;
  std::vector<BlockRow> solve_beside_path(const Row& negligible);
  void clear();

  const SparseFactor& factor_;
  double negligible_;
  Eigen::VectorXd pivots_;
  std::vector<Index> parent_;  ///< of each column in the elimination tree, or -1
  // Per call; zero between calls:
  std::vector<Row> x_;
  std::vector<unsigned char> on_path_, is_large_, visits_children_;
  std::vector<Index> path_;    ///< ancestors of the rows of the right-hand sides, ascending
  std::vector<Index> solved_;  ///< columns that were not skipped
};

}  // namespace stiv
