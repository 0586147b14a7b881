// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// In what the response's step is the shortest.
enum class MetricKind {
  energy,   ///< J'J, damped: the surface moves least
  controls  ///< the controls themselves move least, whatever that does to the surface [P3.2, Algorithm 1]
};

struct MetricOptions {
  /// eps: damping of J'J relative to its mean diagonal; 0.1 smooth, 0.01 tight. In (0, inf).
  double smoothness = 0.1;

  /// Weight w >= 0 of the response: one for each control, (m), or one for each coordinate, (3 m), those of one control
  /// side by side. 0 pins the control or coordinate exactly. Empty: all 1. [P5.2]
  Eigen::VectorXd weights;

  /// Directions along which the three weights of a control act, as the columns of a rotation, (m). Empty: x, y and z.
  std::vector<Eigen::Matrix3d> weight_axes = {};
};

/// The inverse metric of the controls, W^1/2 (J'J + damping)^-1 W^1/2 restricted to coordinates with w > 0: steps along
/// it are steepest for E = 1/2 |f(p) - q~|^2. (mathematics.md, "Metric")
class Metric {
 public:
  virtual ~Metric() = default;

  /// M(p)^-1 g, a covector over controls to a displacement of controls. Rows of pinned controls are absent from it,
  /// pinned coordinates of the others are 0.
  virtual SparseField apply_inverse(const ControlsView& p, const SparseField& g) const = 0;

  /// Does a step move no other controls than those of the covector, or than those of the same body? Then contacts can
  /// be answered one by one without stiffening the whole.
  virtual bool is_local() const { return false; }
};

/// The metric of MetricKind::controls, M^-1 = W; `smoothness` does not matter.
/// @param local do controls move parts of the surface of their own?
std::unique_ptr<Metric> make_control_metric(const MetricOptions& options, Index control_count, bool local = false);

}  // namespace stiv
