// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "editing/edit_context.hpp"

namespace stiv {

/// Bounds on the deviations of controls from their goals, along their weight axes. A control may deviate as far as this
/// moves its fastest vertex by twice the largest miss of its vertices, times its response weight. If it moves none by
/// more than a quarter of its own motion, it counts as if it did. Deviations that are larger already may stay.
/// Rotations have no bounds.
/// (mathematics.md, "Tight edits")
class ControlBox {
 public:
  /// @param goal of the controls, with its surface
  /// @throws Interrupted
  ControlBox(const EditContext& context, const State& accepted, const State& goal, const Execution& execution);

  /// Constraints for the sides that p exceeds and `constraints` do not contain yet.
  std::vector<ControlConstraint> exceeded(const Controls& p, const ConstraintSet& constraints, const Metric& metric,
                                          const Controls& metric_at) const;

  /// Largest deviation of each control along its weight axes, (m, 3); infinite: no bound.
  const Controls& reach() const { return reach_; }

 private:
  Vector3 axis(Index control, int number) const;

  Controls goal_, reach_;
  std::vector<Eigen::Matrix3d> axes_;  ///< empty: x, y and z
  Index first_name_;                   ///< of the sides: limits of scalars have the names before it
};

}  // namespace stiv
