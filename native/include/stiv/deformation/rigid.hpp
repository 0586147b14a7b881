// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/deformation.hpp"

namespace stiv {

/// q_i = centre + R(rotation vector) r_i with r_i = rest_i - mean(rest): six degrees of freedom. [App. B]
/// Controls (2, 3): centre, rotation vector (axis times angle, radians). Rest pose: (mean(rest), 0).
/// The metric is J'J (6 x 6) at the current controls, damped by eps times the diagonal that it has in terms of the
/// angular velocity: the same near no rotation, and not singular at full turns, where the rotation vector is.
/// @throws InputError naming a vertex that is not finite.
std::shared_ptr<const Deformation> make_rigid(const Positions& rest);

/// The controls at which a rigid deformation of `rest` is at rest: (mean, 0).
Controls rigid_rest_controls(const Positions& rest);

}  // namespace stiv
