// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace stiv {

/// y += factor x, (n), not fused: same bits for any vector width.
void add_multiple(Eigen::VectorXd& y, double factor, const double* x);

}  // namespace stiv
