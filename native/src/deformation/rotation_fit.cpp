// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/rotation_fit.hpp"

#include <Eigen/SVD>

namespace stiv {

namespace {

constexpr double least_stiffness = 1e-9;  // of the largest singular value; below it the rotation is not determined

}  // namespace

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
