// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "stiv/execution.hpp"

namespace stiv {

struct LcpOptions {
  int max_sweeps = 500;
  double tolerance = 1e-10;              ///< largest change of a multiplier in a sweep, relative to the largest one
  const Execution* execution = nullptr;  ///< polled for cancellation between sweeps
};

/// Solves 0 <= x, B x + b >= 0, x' (B x + b) = 0 for symmetric positive semi-definite B, (n, n), by projected
/// Gauss-Seidel with subspace minimization on the active rows [Silcowitz, Niebe, Erleben 2010]. Rows without a positive
/// diagonal have x = 0. If there is no solution because constraints contradict each other, it returns the last iterate.
/// [P3.3; Cottle, Pang, Stone 1992, 5.3]
/// @param start first guess, (n) or shorter; missing and negative values count as 0
/// @throws Interrupted by options.execution
Eigen::VectorXd solve_lcp(const Eigen::MatrixXd& B, const Eigen::VectorXd& b, const Eigen::VectorXd& start = {},
                          const LcpOptions& options = {});

}  // namespace stiv
