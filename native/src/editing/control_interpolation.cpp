// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/control_interpolation.hpp"

#include <algorithm>
#include <cmath>

#include "portable_math.hpp"

namespace stiv {

namespace {

using Quaternion = Eigen::Quaterniond;

Quaternion rotation(const Vector3& vector) {
  const double angle = vector.norm();
  if (angle == 0) return Quaternion::Identity();
  const Vector3 imaginary = portable_sin(0.5 * angle) * (vector / angle);
  return {portable_cos(0.5 * angle), imaginary.x(), imaginary.y(), imaginary.z()};
}

/// The rotation vector with an angle in [0, pi].
Vector3 rotation_vector(const Quaternion& rotation) {
  const double length = rotation.vec().norm();
  if (length == 0) return Vector3::Zero();
  const double angle = 2 * portable_atan2(length, std::abs(rotation.w()));
  return std::copysign(angle / length, rotation.w()) * rotation.vec();
}

/// The vector of the rotation that leads from `from` to `to`.
Vector3 turn_between(const Controls& from, const Controls& to, Index row) {
  return rotation_vector(rotation(to.row(row)) * rotation(from.row(row)).conjugate());
}

Vector3 turned(const Vector3& base, const Vector3& turn) {
  if (turn.isZero(0)) return base;
  return rotation_vector(rotation(turn) * rotation(base));
}

}  // namespace

Controls interpolate(const Controls& from, const Controls& to, double fraction,
                     const std::vector<Index>& rotation_rows) {
  if (fraction == 1) return to;
  Controls result = from + fraction * (to - from);
  for (const Index row : rotation_rows)
    result.row(row) = turned(from.row(row), fraction * turn_between(from, to, row)).transpose();
  return result;
}

Controls moved_alike(const Controls& base, const Controls& from, const Controls& to,
                     const std::vector<Index>& rotation_rows) {
  Controls result = base + (to - from);
  for (const Index row : rotation_rows)
    result.row(row) = turned(base.row(row), turn_between(from, to, row)).transpose();
  return result;
}

double largest_rotation(const Controls& from, const Controls& to, const std::vector<Index>& rotation_rows) {
  double largest = 0;
  for (const Index row : rotation_rows) largest = std::max(largest, turn_between(from, to, row).norm());
  return largest;
}

}  // namespace stiv
