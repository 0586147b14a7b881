// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/response/lcp.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "response/add_multiple.hpp"

namespace stiv {

namespace {

constexpr int sweeps_before_solve = 8;  // until the first solve of the active rows; doubles each time

Eigen::VectorXd first_guess(const Eigen::VectorXd& start, Eigen::Index size) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
  const Eigen::Index given = std::min(size, start.size());
  x.head(given) = start.head(given).cwiseMax(0);
  return x;
}

/// B x + b, from the columns of active rows.
Eigen::VectorXd slack_at(const Eigen::MatrixXd& B, const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  Eigen::VectorXd slack = b;
  for (Eigen::Index row = 0; row < x.size(); ++row)
    if (x[row] != 0) add_multiple(slack, x[row], B.col(row).data());
  return slack;
}

/// One sweep over all rows, which updates `slack` = B x + b. Returns the largest change of a multiplier.
/// @param diagonal of B, contiguous, since most rows need no other entry
double sweep(const Eigen::MatrixXd& B, const Eigen::VectorXd& diagonal, Eigen::VectorXd& x, Eigen::VectorXd& slack) {
  double largest_change = 0;
  for (Eigen::Index row = 0; row < x.size(); ++row) {
    if (!(diagonal[row] > 0)) continue;
    const double change = std::max(0.0, x[row] - slack[row] / diagonal[row]) - x[row];
    if (change == 0) continue;
    x[row] += change;
    add_multiple(slack, change, B.col(row).data());  // the column of a symmetric matrix: contiguous
    largest_change = std::max(largest_change, std::abs(change));
  }
  return largest_change;
}

/// Moves toward the solution of the active rows, taken as equations, until a multiplier reaches zero. Sweeps alone need
/// hundreds of passes if rows are nearly dependent. Both lower the same energy, so together they converge. Does nothing
/// if the rows are dependent. [Silcowitz, Niebe, Erleben 2010]
void solve_active(const Eigen::MatrixXd& B, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  constexpr double least_pivot = 1e-10;  // relative to the largest
  std::vector<Eigen::Index> active;
  for (Eigen::Index row = 0; row < x.size(); ++row)
    if (x[row] > 0) active.push_back(row);
  if (active.empty()) return;
  const Eigen::LLT<Eigen::MatrixXd> factor(B(active, active));
  if (factor.info() != Eigen::Success) return;
  const Eigen::VectorXd pivots = factor.matrixLLT().diagonal().cwiseAbs2();
  if (!(pivots.minCoeff() > least_pivot * pivots.maxCoeff())) return;
  const Eigen::VectorXd from = x(active), to = factor.solve(-b(active));
  if (!to.allFinite()) return;
  double part = 1;
  for (Eigen::Index k = 0; k < to.size(); ++k)
    if (to[k] < 0) part = std::min(part, from[k] / (from[k] - to[k]));
  x(active) = (from + part * (to - from)).cwiseMax(0);
}

}  // namespace

Eigen::VectorXd solve_lcp(const Eigen::MatrixXd& B, const Eigen::VectorXd& b, const Eigen::VectorXd& start,
                          const LcpOptions& options) {
  Eigen::VectorXd x = first_guess(start, b.size());
  const Eigen::VectorXd diagonal = B.diagonal();
  for (Eigen::Index row = 0; row < x.size(); ++row)
    if (!(diagonal[row] > 0)) x[row] = 0;
  Eigen::VectorXd slack = slack_at(B, b, x);
  int next_solve = sweeps_before_solve;
  for (int k = 1; k <= options.max_sweeps; ++k) {
    if (options.execution != nullptr) options.execution->check();
    const double change = sweep(B, diagonal, x, slack);
    if (change <= options.tolerance * (x.size() > 0 ? x.maxCoeff() : 0)) break;
    if (k < next_solve) continue;
    next_solve *= 2;
    solve_active(B, b, x);
    slack = slack_at(B, b, x);
  }
  return x;
}

}  // namespace stiv
