// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/deformation.hpp"

namespace stiv {

/// q_i = centre + R diag(s) R' r_i with r_i = rest_i - mean(rest): an object scaled along its own axes, the columns of
/// the rotation R. Controls (2, 3): centre, scale factors s (1 = as it is). Linear in its controls.
/// The metric is J'J (6 x 6), damped by eps times its own diagonal.
/// @throws InputError: a vertex that is not finite, a matrix that is not a rotation.
std::shared_ptr<const Deformation> make_scaling(const Positions& rest, const Eigen::Matrix3d& rotation);

/// The controls at which a scaling of `rest` is at rest: (mean, (1, 1, 1)).
Controls scaling_rest_controls(const Positions& rest);

}  // namespace stiv
