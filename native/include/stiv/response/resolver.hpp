// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/deformation.hpp"
#include "stiv/volumes/stiv.hpp"

namespace stiv {

/// A linear constraint on the controls, row . p >= bound, normalised in the metric, with its image M^-1 row.
struct ControlConstraint {
  SparseField row;
  SparseField step;
  double bound = 0;
};

/// Linearises STIVs at the controls p; constraints that no free control can change are left out.
std::vector<ControlConstraint> control_constraints(const std::vector<Stiv>& stivs, const Deformation& deformation,
                                                   const Metric& metric, const Controls& p);

/// The point nearest to `from` in the metric that satisfies all constraints: from + sum lambda_r step_r, with the LCP's
/// multipliers. `multipliers` is the first guess and receives the solution.
Controls project(const Controls& from, const std::vector<ControlConstraint>& constraints, Eigen::VectorXd& multipliers);

}  // namespace stiv
