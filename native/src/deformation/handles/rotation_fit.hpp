// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/types.hpp"

namespace stiv {

/// The rotation R nearest to a matrix A, and its derivative: a change dA turns it by dR = R [w]x, w = response (X -
/// X')_axial, X = R' dA. The response is 0 in directions in which A does not determine the rotation.
struct RotationFit {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d response = Eigen::Matrix3d::Zero();
};

RotationFit fit_rotation(const Eigen::Matrix3d& matrix);

/// The same up to rounding, by Newton's method from a nearby rotation: ten times as fast as singular values, which are
/// used only where the method does not converge. It ends after the first step of at most `settled_turn` radians. The
/// remaining error is of the order of that step's square.
RotationFit fit_rotation(const Eigen::Matrix3d& matrix, const Eigen::Matrix3d& guess, double settled_turn = 1e-7);

/// (S - S')_axial: the vector v with [v]x = S - S'.
inline Vector3 axial(const Eigen::Matrix3d& s) { return {s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1)}; }

}  // namespace stiv
