// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/response/lcp.hpp"
#include "stiv/response/resolver.hpp"

namespace stiv {

/// What a sweep over the rows costs, in multiplications; with the rows' Gram matrix it would cost their number squared.
std::size_t sweep_cost(const std::vector<ControlConstraint>& constraints);

/// The point nearest to `from` in the metric that satisfies all constraints, by visiting one after the other and
/// keeping the point itself up to date: the sweeps of `solve_lcp` without its matrix, for thousands of constraints that
/// touch few controls each. [Hildreth 1957]
/// @param multipliers first guess, shorter or empty: the rest is 0; the multipliers found
Controls project_by_rows(const std::vector<ControlConstraint>& constraints, const Controls& from,
                         Eigen::VectorXd& multipliers, const LcpOptions& options);

}  // namespace stiv
