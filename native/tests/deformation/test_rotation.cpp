// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "deformation/rotation.hpp"

using namespace stiv;

namespace {

const double angles[] = {0, 1e-9, 1e-4, 0.1, 0.2499, 0.2501, 1, 3.1, std::numbers::pi, 5, 2 * std::numbers::pi, 9};

}  // namespace

TEST_CASE("rotation: equals Eigen's angle and axis") {
  const Vector3 axis = Vector3(1, -2, 0.5).normalized();
  for (const double angle : angles) {
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    CHECK((rotation_matrix(angle * axis) - expected).norm() < 1e-14);
  }
}

TEST_CASE("rotation: the left Jacobian is the integral of rotations") {
  // J_l(v) = integral of exp(s [v]x) for s in [0, 1]; by Gauss-Legendre with 5 points on each of 64 intervals.
  const double node[] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
  const double weight[] = {128.0 / 225, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891, 0.2369268850561891};
  const Vector3 axis = Vector3(0.3, 1, 2).normalized();
  for (const double angle : angles) {
    Eigen::Matrix3d integral = Eigen::Matrix3d::Zero();
    for (int piece = 0; piece < 64; ++piece)
      for (int k = 0; k < 5; ++k)
        integral +=
            weight[k] / 128 * Eigen::AngleAxisd((piece + (1 + node[k]) / 2) / 64 * angle, axis).toRotationMatrix();
    CHECK((left_jacobian(angle * axis) - integral).norm() < 1e-13);
  }
}
