// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/deformation.hpp"
#include "stiv/execution.hpp"
#include "stiv/volumes/stiv.hpp"

namespace stiv {

/// How constraints are met together. [P3.3]
enum class ConstraintSolver {
  lcp,    ///< as inequalities, with multipliers that are not negative: contacts push
  linear  ///< as equations: contacts may also pull
};

/// A linear constraint on the controls, row . p >= bound, with its image step = M^-1 row; row . step = 1.
struct ControlConstraint {
  SparseField row;
  SparseField step;
  double bound = 0;
};

/// Linearises STIVs at the controls p: V + row . (p' - p) >= 0. Constraints that no free control can change are left
/// out. (mathematics.md, Eq. 5)
/// @param metric_at controls at which the metric is taken; the same for constraints that are solved together
/// @param execution shares the work, and is asked whether to go on: there may be a STIV for each of thousands of
/// contacts; null: one thread
std::vector<ControlConstraint> control_constraints(const std::vector<Stiv>& stivs, const Deformation& deformation,
                                                   const Controls& p, const Metric& metric, const Controls& metric_at,
                                                   const Execution* execution = nullptr);

/// Constraints that are met together. The last multipliers are the next first guess and the Gram matrix, where it is
/// used, grows with the constraints, so that adding a few rows and projecting again is cheap.
class ConstraintSet {
 public:
  void add(std::vector<ControlConstraint> constraints);
  std::size_t size() const { return constraints_.size(); }

  /// Forget the constraints that the last projection did not rest on; they are found again if they are met again.
  void drop_inactive();

  /// The point nearest to `from` in the metric that satisfies all constraints: from + sum lambda_r step_r with the
  /// multipliers of the LCP. (mathematics.md, Eq. 6)
  Controls project(const Controls& from, const Execution& execution);

  /// The same with all constraints as equations, of which the least multipliers solve as many as can be solved.
  /// [P3.3; Harmon et al. 2008]
  Controls project_as_equations(const Controls& from, const Execution& execution);

 private:
  void complete_gram(const Execution& execution);
  Eigen::VectorXd excess_at(const Controls& p) const;
  Controls moved_by_multipliers(const Controls& from) const;

  std::vector<ControlConstraint> constraints_;
  Eigen::MatrixXd gram_;  ///< row_r . step_s, of the first constraints: as far as it was needed
  Eigen::VectorXd multipliers_;
};

}  // namespace stiv
