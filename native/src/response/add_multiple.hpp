// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace stiv {

/// y += factor x, (n), none fused: the same bits whatever the width of vectors.
void add_multiple(Eigen::VectorXd& y, double factor, const double* x);

}  // namespace stiv
