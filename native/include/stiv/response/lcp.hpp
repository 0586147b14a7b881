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
/// Gauss-Seidel, with solutions on the active rows now and then (Silcowitz, Niebe, Erleben, "Projected Gauss-Seidel
/// Subspace Minimization Method for Interactive Rigid Body Dynamics", GRAPP 2010). Rows whose diagonal is not positive
/// constrain nothing that can be changed: their x stays 0. Without a solution (constraints that contradict each other)
/// the multipliers after the last sweep are returned. [P3.3; Cottle, Pang, Stone 1992, 5.3]
/// @param start first guess, (n) or shorter (the rest is 0); negative values count as 0
/// @throws Interrupted if options.execution says so
Eigen::VectorXd solve_lcp(const Eigen::MatrixXd& B, const Eigen::VectorXd& b, const Eigen::VectorXd& start = {},
                          const LcpOptions& options = {});

}  // namespace stiv
