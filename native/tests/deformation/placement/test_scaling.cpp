// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/finite_differences.hpp"
#include "stiv/deformation/placement.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

Eigen::Matrix3d oblique_axes() { return Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized()).toRotationMatrix(); }

}  // namespace

TEST_CASE("scaling: along the object's own axes") {
  const Positions rest = random_positions(8, 1);
  const Eigen::Matrix3d axes = oblique_axes();
  const auto scaling = make_scaling(rest, axes);
  Controls p = scaling_rest_controls(rest);
  CHECK((scaling->surface(p) - rest).norm() < 1e-14);
  p.row(1) << 2, 1, -0.5;
  const Positions moved = scaling->surface(p);
  for (Index k = 0; k < 8; ++k) {
    const Vector3 before = axes.transpose() * (rest.row(k) - p.row(0)).transpose();
    const Vector3 after = axes.transpose() * (moved.row(k) - p.row(0)).transpose();
    CHECK((after - before.cwiseProduct(Vector3(2, 1, -0.5))).norm() < 1e-14);
  }
}

TEST_CASE("scaling: derivatives and metric") {
  const auto scaling = make_scaling(random_positions(8, 1), oblique_axes());
  const Controls p = random_positions(2, 3);
  check_derivatives(*scaling, p);
  const Eigen::VectorXd diagonal = dense_jacobian(*scaling, p).colwise().squaredNorm();
  MetricOptions options;
  check_metric(*scaling, p, options, 0.1 * diagonal);
  options.smoothness = 0.01;
  options.weights = Eigen::Vector2d(0, 3);
  check_metric(*scaling, p, options, 0.01 * diagonal);
  for (unsigned seed = 0; seed < 6; ++seed)
    check_metric(*scaling, p, random_axis_weights(2, seed, seed % 2 == 1), 0.1 * diagonal, DampingAxes::world);
}

TEST_CASE("scaling: invalid input is named") {
  const Positions rest = random_positions(3, 1);
  CHECK_THROWS_WITH_AS(make_scaling(rest, 2 * oblique_axes()), doctest::Contains("not a rotation"), InputError);
  CHECK_THROWS_WITH_AS(make_scaling(rest, -oblique_axes()), doctest::Contains("not a rotation"), InputError);
}
