// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Norm minimized by the response step.
enum class MetricKind {
  energy,   ///< J'J, damped: the least motion of the surface
  controls  ///< the least motion of the controls [P3.2, Algorithm 1]
};

struct MetricOptions {
  /// Damping of J'J relative to its mean diagonal: 0.1 smooth, 0.01 tight. In (0, inf).
  double smoothness = 0.1;

  /// Response weights w >= 0: one for each control, (m), or one for each coordinate, (3 m), those of one control side
  /// by side. 0 pins the control or coordinate exactly. Empty: all 1. [P5.2]
  Eigen::VectorXd weights;

  /// Directions of the three weights of each control, as the columns of a rotation, (m). Empty: x, y and z.
  std::vector<Eigen::Matrix3d> weight_axes = {};
};

/// The inverse metric of the controls, W^1/2 (J'J + damping)^-1 W^1/2, restricted to coordinates with w > 0. Steps
/// along it are steepest for E = 1/2 |f(p) - q~|^2. (mathematics.md, "Metric")
class Metric {
 public:
  virtual ~Metric() = default;

  /// M(p)^-1 g: the displacement of the controls for a covector over them. Pinned controls have no row in it, pinned
  /// coordinates of other controls are 0.
  virtual SparseField apply_inverse(const ControlsView& p, const SparseField& g) const = 0;

  /// False while a thread prepares the inverse; until then, `apply_inverse` waits.
  virtual bool is_ready() const { return true; }

  /// True if a step moves only the covector's controls, or those of the same body. Contacts can then be resolved one by
  /// one without stiffening the rest.
  virtual bool is_local() const { return false; }
};

/// Whether each control moves vertices of its own.
enum class ControlSupport { shared, disjoint };

/// The metric of MetricKind::controls, M^-1 = W. It ignores `smoothness`.
/// @param support decides Metric::is_local
std::unique_ptr<Metric> make_control_metric(const MetricOptions& options, Index control_count,
                                            ControlSupport support = ControlSupport::shared);

}  // namespace stiv
