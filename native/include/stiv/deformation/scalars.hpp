// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// A dense derivative dq/ds of a surface q, (n, 3), by k scalars s: (3 n, k). Row 3 i + a is coordinate a of vertex i.
using ScalarJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// f(s), (n, 3), for scalars s, (k), or nothing if there is no surface with this topology.
using ScalarEvaluation = std::function<std::optional<Positions>(const Eigen::VectorXd& values)>;

/// A deformation q = f(s) by scalars: angles, slider values, lengths. Row k of its controls is (s_k, 0, 0).
/// The surface comes from f alone. J only directs the response, as in observed.hpp, and f is called as there.
/// - Edits never leave the limits. A goal beyond them is replaced by the nearest values within them.
/// - Each accepted step is at most `longest_step` of each scalar. The surface moves linearly within a step, so shorter
///   steps follow a curved motion more closely.
/// - The metric is J'J, damped by `smoothness` times its own diagonal: the response does not depend on the units of the
///   scalars. Response weights are one for each control, (m); of three, only the first counts.
class ScalarDeformation : public ComposableDeformation {
 public:
  /// Replaces J, for all sessions of deformations that contain this one, from their next call on. Not during a call.
  /// @throws InputError for another size, or naming the vertex of a number that is not finite
  virtual void set_jacobian(ScalarJacobian jacobian) = 0;
};

/// @param limits empty vectors: none
/// @throws InputError naming the scalar: limits in the wrong order or not numbers, a step that is not positive; vectors
///         of the wrong size; naming the vertex of a number in J that is not finite
std::shared_ptr<ScalarDeformation> make_scalars(ScalarEvaluation evaluate, ScalarJacobian jacobian,
                                                ScalarLimits limits = {});

}  // namespace stiv
