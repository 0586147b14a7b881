// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/types.hpp"

namespace stiv {

/// [v]x: the matrix of the cross product with v.
Eigen::Matrix3d cross_matrix(const Vector3& v);

/// Rotation about axis v by |v| radians, for any |v|. (Rodrigues' formula)
Eigen::Matrix3d rotation_matrix(const Vector3& v);

/// J_l(v): a change dv of the rotation vector is a rotation by J_l(v) dv in world axes. Singular at |v| = 2 pi k,
/// k = 1, 2, ..., where only changes along v rotate. (Left Jacobian of SO(3); Sola et al. 2018, Eq. 145)
Eigen::Matrix3d left_jacobian(const Vector3& v);

}  // namespace stiv
