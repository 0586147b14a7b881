// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/rotation_fit.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "deformation/rotation.hpp"

namespace stiv {

namespace {

constexpr double least_stiffness = 1e-9;  // of the largest singular value; below it the rotation is not determined

constexpr int most_newton_steps = 12;
constexpr double least_curvature = 1e-6;  // of the trace; below it singular values decide

/// The inverse of a symmetric matrix, if it is positive definite by a margin.
bool invert_definite(const Eigen::Matrix3d& matrix, double margin, Eigen::Matrix3d& inverse) {
  Eigen::Matrix3d cofactors;
  for (int k = 0; k < 3; ++k) cofactors.col(k) = matrix.col((k + 1) % 3).cross(matrix.col((k + 2) % 3));
  const double determinant = matrix.col(0).dot(cofactors.col(0));
  const double scale = matrix.trace();
  // Sylvester's criterion with margins: leading minors.
  if (!(matrix(0, 0) > margin * scale) || !(cofactors(2, 2) > margin * scale * matrix(0, 0)) ||
      !(determinant > margin * scale * cofactors(2, 2)))
    return false;
  inverse = cofactors.transpose() / determinant;
  return true;
}

/// A rotation about w by |w| to third order, rational in w.
Eigen::Matrix3d rotation_by(const Vector3& w) {
  const Eigen::Matrix3d half = cross_matrix(w / 2);
  return Eigen::Matrix3d::Identity() + 2 / (1 + w.squaredNorm() / 4) * (half + half * half);
}

/// Removes rounding errors from a product of rotations.
Eigen::Matrix3d orthonormal(const Eigen::Matrix3d& rotation) {
  return rotation * (3 * Eigen::Matrix3d::Identity() - rotation.transpose() * rotation) / 2;
}

}  // namespace

RotationFit fit_rotation(const Eigen::Matrix3d& matrix, const Eigen::Matrix3d& guess, double settled_turn) {
  // R is the nearest rotation where R'A is symmetric and tr(R'A) - R'A positive definite, and there is no other.
  RotationFit fit{guess, {}};
  for (int step = 0; step < most_newton_steps; ++step) {
    const Eigen::Matrix3d seen = fit.rotation.transpose() * matrix, stretch = (seen + seen.transpose()) / 2;
    const Eigen::Matrix3d curvature = stretch.trace() * Eigen::Matrix3d::Identity() - stretch;
    if (!invert_definite(curvature, least_curvature, fit.response)) break;
    const Vector3 turn = fit.response * axial(seen);
    fit.rotation = fit.rotation * rotation_by(turn);
    if (turn.squaredNorm() > settled_turn * settled_turn) continue;
    fit.rotation = orthonormal(fit.rotation);
    return fit;
  }
  return fit_rotation(matrix);
}

RotationFit fit_rotation(const Eigen::Matrix3d& matrix) {
  RotationFit fit;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.info() != Eigen::Success) return fit;  // not finite
  Vector3 stretch = svd.singularValues();
  if (!(stretch[0] > 0)) return fit;
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) {
    u.col(2) = -u.col(2);
    stretch[2] = -stretch[2];
  }
  fit.rotation = u * svd.matrixV().transpose();
  // A = R P with P = V stretch V'. The skew part of R' dA is P W + W P = [(tr P - P) w]x for dR = R W, W = [w]x.
  const Vector3 stiffness = Vector3::Constant(stretch.sum()) - stretch;
  Vector3 inverse = Vector3::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (stiffness[axis] > least_stiffness * stretch[0]) inverse[axis] = 1 / stiffness[axis];
  fit.response = svd.matrixV() * inverse.asDiagonal() * svd.matrixV().transpose();
  return fit;
}

}  // namespace stiv
