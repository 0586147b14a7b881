// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace stiv {

/// Solves 0 <= x, B x + b >= 0, x' (B x + b) = 0 for symmetric positive semi-definite B by projected Gauss-Seidel.
/// [P3.3; Cottle, Pang, Stone 1992]
/// @param start first guess, (n), or empty for zero
Eigen::VectorXd solve_lcp(const Eigen::MatrixXd& B, const Eigen::VectorXd& b, const Eigen::VectorXd& start = {},
                          int max_sweeps = 500, double tolerance = 1e-10);

}  // namespace stiv
