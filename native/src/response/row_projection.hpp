// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/response/lcp.hpp"
#include "stiv/response/resolver.hpp"

namespace stiv {

/// The cost of a sweep over the rows in multiplications. With a Gram matrix it is the number of rows squared.
std::size_t sweep_cost(const std::vector<ControlConstraint>& constraints);

/// The point closest to `from` in the metric that satisfies all constraints, by sweeps that update the point after each
/// constraint. Like solve_lcp without its matrix, for thousands of constraints on few controls each. [Hildreth 1957]
/// @param multipliers in: first guess, of which missing values are 0; out: the multipliers
Controls project_by_rows(const std::vector<ControlConstraint>& constraints, const Controls& from,
                         Eigen::VectorXd& multipliers, const LcpOptions& options);

}  // namespace stiv
