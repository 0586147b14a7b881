// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/deformation.hpp"
#include "stiv/execution.hpp"
#include "stiv/volumes/relative.hpp"

namespace stiv {

/// How constraints are solved together. [P3.3]
enum class ConstraintSolver {
  lcp,    ///< as inequalities with nonnegative multipliers: contacts push
  linear  ///< as equations: contacts may also pull
};

/// A linear constraint on the controls, row . p >= bound, with step = M^-1 row, scaled so that row . step = 1.
struct ControlConstraint {
  SparseField row;
  SparseField step;
  double bound = 0;
  Index limit = -1;  ///< the limit of a scalar that it keeps (ControlLimits); -1: none
};

/// Linearises STIVs at the controls p: V + row . (p' - p) >= 0. Constraints that no free control changes are left out.
/// (mathematics.md, Eq. 5)
/// @param metric_at controls at which the metric is evaluated, the same for all constraints solved together
/// @param execution threads and cancellation; null: one thread
/// @throws Interrupted
std::vector<ControlConstraint> control_constraints(const std::vector<Stiv>& stivs, const Deformation& deformation,
                                                   const Controls& p, const Metric& metric, const Controls& metric_at,
                                                   const Execution* execution = nullptr);

/// Constraints that are solved together. The last multipliers are the next first guess, and the Gram matrix grows with
/// the constraints, so that adding a few rows and projecting again is cheap.
class ConstraintSet {
 public:
  void add(std::vector<ControlConstraint> constraints);
  std::size_t size() const { return constraints_.size(); }
  bool has_limit(Index limit) const;

  /// Removes constraints that were inactive in the last projection.
  void drop_inactive();

  /// Removes the constraint with the number `first`, and from there on each `period`-th one.
  void drop_part(Index period, Index first);

  /// The point closest to `from` in the metric that satisfies all constraints: from + sum lambda_r step_r with the
  /// multipliers of the LCP. (mathematics.md, Eq. 6)
  Controls project(const Controls& from, const Execution& execution);

  /// The same with all constraints as equations, in the least-squares sense with the smallest multipliers.
  /// [P3.3; Harmon et al. 2008]
  Controls project_as_equations(const Controls& from, const Execution& execution);

 private:
  void keep(const std::vector<Eigen::Index>& numbers);
  void complete_gram(const Execution& execution);
  Eigen::VectorXd excess_at(const Controls& p) const;
  Controls moved_by_multipliers(const Controls& from) const;

  std::vector<ControlConstraint> constraints_;
  Eigen::MatrixXd gram_;  ///< row_r . step_s of the first constraints
  Eigen::VectorXd multipliers_;
};

}  // namespace stiv
