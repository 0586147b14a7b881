// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/rotation_fit.hpp"

#include "deformation/finite_differences.hpp"
#include "deformation/rotation.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

Eigen::Matrix3d random_matrix(unsigned seed) { return random_positions(3, seed); }

}  // namespace

TEST_CASE("rotation fit: the rotation of a product of rotation and stretch") {
  const Eigen::Matrix3d turn = rotation_matrix({0.4, -1.2, 0.9});
  const Eigen::Matrix3d stretch = Vector3(2, 0.5, 1e-3).asDiagonal();
  CHECK((fit_rotation(turn * stretch).rotation - turn).norm() < 1e-12);
  const Eigen::Matrix3d flat = Vector3(2, 0.5, 0).asDiagonal();
  CHECK((fit_rotation(turn * flat).rotation - turn).norm() < 1e-12);
  CHECK(fit_rotation(Eigen::Matrix3d::Zero()).rotation == Eigen::Matrix3d::Identity());
}

TEST_CASE("rotation fit: always a rotation, and the closest one") {
  for (unsigned seed = 1; seed < 20; ++seed) {
    const Eigen::Matrix3d matrix = random_matrix(seed), rotation = fit_rotation(matrix).rotation;
    CHECK((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    CHECK(rotation.determinant() > 0);
    for (unsigned other = 1; other < 10; ++other) {
      const Eigen::Matrix3d near = rotation * rotation_matrix(0.2 * random_matrix(100 + other).row(0).transpose());
      CHECK((matrix - rotation).norm() <= (matrix - near).norm() + 1e-12);
    }
  }
}

TEST_CASE(
    "rotation fit: Newton's method equals singular values from any first guess, also for mirrored and flat matrices") {
  for (unsigned seed = 1; seed < 60; ++seed) {
    Eigen::Matrix3d matrix = random_matrix(seed);
    if (seed % 3 == 0) matrix.col(2) = matrix.col(0) - 0.4 * matrix.col(1);
    const RotationFit expected = fit_rotation(matrix);
    for (const double angle : {0.0, 1e-9, 0.01, 0.4, 3.0}) {
      const Vector3 turn = angle * random_matrix(seed + 70).row(0).transpose().normalized();
      const RotationFit found = fit_rotation(matrix, expected.rotation * rotation_matrix(turn));
      CHECK((found.rotation - expected.rotation).norm() < 1e-11 * (1 + expected.response.norm()));
      CHECK((found.response - expected.response).norm() < 1e-6 * expected.response.norm());
    }
  }
}

TEST_CASE("rotation fit: the response against finite differences, also for mirrored and flat matrices") {
  constexpr double step = 1e-6;
  for (unsigned seed = 1; seed < 20; ++seed) {
    Eigen::Matrix3d matrix = random_matrix(seed);
    if (seed % 3 == 0) matrix.col(2) = matrix.col(0) - 0.4 * matrix.col(1);
    const Eigen::Matrix3d change = random_matrix(seed + 50);
    const RotationFit fit = fit_rotation(matrix);
    const Eigen::Matrix3d expected =
        (fit_rotation(matrix + step * change).rotation - fit_rotation(matrix - step * change).rotation) / (2 * step);
    const Vector3 turn = fit.response * axial(fit.rotation.transpose() * change);
    CHECK((fit.rotation * cross_matrix(turn) - expected).norm() < 1e-4 * (1 + expected.norm()));
  }
}
