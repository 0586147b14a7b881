// SPDX-License-Identifier: GPL-3.0-or-later
#include "response/row_projection.hpp"

#include <algorithm>
#include <cmath>

#include "response/sparse_fields.hpp"

namespace stiv {

namespace {

void make_as_long(Eigen::VectorXd& multipliers, Eigen::Index size) {
  const Eigen::Index given = std::min(size, multipliers.size());
  multipliers.conservativeResize(size);
  multipliers.head(given) = multipliers.head(given).cwiseMax(0);
  multipliers.tail(size - given).setZero();
}

/// One sweep over all rows, of length 1 in the metric. Returns the largest change of a multiplier.
double sweep(const std::vector<ControlConstraint>& constraints, Controls& p, Eigen::VectorXd& multipliers) {
  double largest_change = 0;
  Eigen::Index r = 0;
  for (const ControlConstraint& constraint : constraints) {
    double& multiplier = multipliers[r++];
    const double slack = dot(constraint.row, p) - constraint.bound;
    const double change = std::max(0.0, multiplier - slack) - multiplier;
    if (change == 0) continue;
    multiplier += change;
    add_scaled(p, change, constraint.step);
    largest_change = std::max(largest_change, std::abs(change));
  }
  return largest_change;
}

}  // namespace

std::size_t sweep_cost(const std::vector<ControlConstraint>& constraints) {
  std::size_t entries = 0;
  for (const ControlConstraint& constraint : constraints)
    entries += constraint.row.index.size() + constraint.step.index.size();
  return 3 * entries;
}

Controls project_by_rows(const std::vector<ControlConstraint>& constraints, const Controls& from,
                         Eigen::VectorXd& multipliers, const LcpOptions& options) {
  make_as_long(multipliers, static_cast<Eigen::Index>(constraints.size()));
  Controls p = from;
  for (Eigen::Index r = 0; r < multipliers.size(); ++r)
    if (multipliers[r] > 0) add_scaled(p, multipliers[r], constraints[at(r)].step);
  for (int k = 0; k < options.max_sweeps; ++k) {
    if (options.execution != nullptr) options.execution->check();
    const double change = sweep(constraints, p, multipliers);
    if (change <= options.tolerance * (multipliers.size() > 0 ? multipliers.maxCoeff() : 0)) break;
  }
  return p;
}

}  // namespace stiv
