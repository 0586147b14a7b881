// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/rotation.hpp"

#include <cmath>

#include "portable_math.hpp"

namespace stiv {

namespace {

/// sin(x) / x
double sine_ratio(double x) { return x == 0 ? 1 : portable_sin(x) / x; }

/// (1 - cos x) / x^2, by the half angle, without cancellation.
double cosine_ratio(double x) {
  const double half = sine_ratio(x / 2);
  return half * half / 2;
}

/// (x - sin x) / x^3. Near 0, where the difference cancels, the series up to x^8 / 11! is exact to rounding.
double sine_remainder(double x) {
  const double s = x * x;
  if (std::abs(x) > 0.25) return (x - portable_sin(x)) / (s * x);
  return (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110)))) / 6;
}

}  // namespace

Eigen::Matrix3d cross_matrix(const Vector3& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

Eigen::Matrix3d rotation_matrix(const Vector3& v) {
  const double angle = v.norm();
  const Eigen::Matrix3d cross = cross_matrix(v);
  return Eigen::Matrix3d::Identity() + sine_ratio(angle) * cross + cosine_ratio(angle) * cross * cross;
}

Eigen::Matrix3d left_jacobian(const Vector3& v) {
  const double angle = v.norm();
  const Eigen::Matrix3d cross = cross_matrix(v);
  return Eigen::Matrix3d::Identity() + cosine_ratio(angle) * cross + sine_remainder(angle) * cross * cross;
}

}  // namespace stiv
