// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/response/lcp.hpp"

#include <algorithm>
#include <cmath>

namespace stiv {

namespace {

Eigen::VectorXd first_guess(const Eigen::VectorXd& start, Eigen::Index size) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
  const Eigen::Index given = std::min(size, start.size());
  x.head(given) = start.head(given).cwiseMax(0);
  return x;
}

/// One sweep over all rows; keeps `slack` = B x + b up to date. Returns the largest change of a multiplier.
double sweep(const Eigen::MatrixXd& B, Eigen::VectorXd& x, Eigen::VectorXd& slack) {
  double largest_change = 0;
  for (Eigen::Index row = 0; row < x.size(); ++row) {
    const double diagonal = B(row, row);
    if (!(diagonal > 0)) continue;
    const double change = std::max(0.0, x[row] - slack[row] / diagonal) - x[row];
    if (change == 0) continue;
    x[row] += change;
    slack += change * B.col(row);  // the column of a symmetric matrix: contiguous
    largest_change = std::max(largest_change, std::abs(change));
  }
  return largest_change;
}

}  // namespace

Eigen::VectorXd solve_lcp(const Eigen::MatrixXd& B, const Eigen::VectorXd& b, const Eigen::VectorXd& start,
                          const LcpOptions& options) {
  Eigen::VectorXd x = first_guess(start, b.size());
  for (Eigen::Index row = 0; row < x.size(); ++row)
    if (!(B(row, row) > 0)) x[row] = 0;
  Eigen::VectorXd slack = B * x + b;
  for (int k = 0; k < options.max_sweeps; ++k) {
    if (options.execution != nullptr) options.execution->check();
    const double change = sweep(B, x, slack);
    if (change <= options.tolerance * (x.size() > 0 ? x.maxCoeff() : 0)) break;
  }
  return x;
}

}  // namespace stiv
