// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "stiv/deformation/deformation.hpp"

namespace stiv {

/// A rigid motion, q_i = center + R(rotation vector) r_i with r_i = rest_i - mean(rest). [App. B]
/// Controls, (2, 3): center, rotation vector (axis times angle in radians).
/// The metric is J'J, (6, 6), at the current controls. Its damping is relative to the diagonal of J'J in terms of
/// angular velocity, which is not singular at full turns, where the rotation vector is.
/// With a pivot the rotation is about it: q_i = center + (pivot - mean(rest)) + R (rest_i - pivot). The center, which
/// is mean(rest) at rest, then only translates. The metric neglects the coupling of both rows, so pin one of them.
/// @throws InputError if the pivot is not finite, or naming a vertex that is not
std::shared_ptr<const Deformation> make_rigid(const Positions& rest, const std::optional<Vector3>& pivot = {});

/// The rest controls of make_rigid(rest): (mean(rest), 0).
Controls rigid_rest_controls(const Positions& rest);

/// A scaling of an object along its own axes, the columns of the rotation R: q_i = center + R diag(s) R' r_i with
/// r_i = rest_i - mean(rest). Controls, (2, 3): center, scale factors s. Linear in its controls.
/// The metric is J'J, (6, 6), damped relative to its own diagonal.
/// @throws InputError if a vertex is not finite or the matrix is not a rotation
std::shared_ptr<const Deformation> make_scaling(const Positions& rest, const Eigen::Matrix3d& rotation);

/// The rest controls of make_scaling(rest, rotation): (mean(rest), (1, 1, 1)).
Controls scaling_rest_controls(const Positions& rest);

}  // namespace stiv
