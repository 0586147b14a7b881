// SPDX-License-Identifier: GPL-3.0-or-later
#include <numbers>

#include "deformation/finite_differences.hpp"
#include "stiv/deformation/placement.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

/// Controls turned by `angle` about an oblique axis.
Controls turned(double angle) {
  Controls p = random_positions(2, 4);
  p.row(1) = angle * Vector3(0.6, -0.48, 0.64).transpose();
  return p;
}

const double angles[] = {0, 1e-6, 0.2, 1, std::numbers::pi, 2 * std::numbers::pi - 1e-3, 2 * std::numbers::pi, 8};

}  // namespace

TEST_CASE("rigid: the rest surface is exact, and distances are preserved") {
  const Positions rest = random_positions(9, 1);
  const auto rigid = make_rigid(rest);
  CHECK((rigid->surface(rigid_rest_controls(rest)) - rest).norm() < 1e-14);
  const Positions q = rigid->surface(turned(2.5));
  for (Index k = 1; k < 9; ++k)
    CHECK((q.row(k) - q.row(0)).norm() == doctest::Approx((rest.row(k) - rest.row(0)).norm()));
  CHECK((q.colwise().mean() - turned(2.5).row(0)).norm() < 1e-14);
}

TEST_CASE("rigid: derivatives at all angles") {
  const auto rigid = make_rigid(random_positions(9, 1));
  for (const double angle : angles) check_derivatives(*rigid, turned(angle));
}

TEST_CASE("rigid: metric against the dense one") {
  const Positions rest = random_positions(9, 1);
  const auto rigid = make_rigid(rest);
  for (const double angle : angles) {
    // The damping is the diagonal of J'J about the turned body's rest pose, where J_l = 1.
    const Positions turned_rest = rigid->surface(turned(angle));
    const auto turned_body = make_rigid(turned_rest);
    const Eigen::VectorXd diagonal =
        dense_jacobian(*turned_body, rigid_rest_controls(turned_rest)).colwise().squaredNorm();
    MetricOptions options;
    check_metric(*rigid, turned(angle), options, 0.1 * diagonal);
    options.weights = Eigen::Vector2d(2, 0);
    check_metric(*rigid, turned(angle), options, 0.1 * diagonal);
    for (unsigned seed = 0; seed < 6; ++seed)
      check_metric(*rigid, turned(angle), random_axis_weights(2, seed, seed % 2 == 1), 0.1 * diagonal,
                   DampingAxes::world);
  }
}

TEST_CASE("rigid: points on a line and single points have a finite metric") {
  for (const Index count : {1, 4}) {
    Positions rest = Positions::Zero(count, 3);
    for (Index k = 0; k < count; ++k) rest(k, 0) = k;
    const auto rigid = make_rigid(rest);
    const Controls p = rigid_rest_controls(rest);
    const SparseField pulled = rigid->pull_back(p, random_field(count, 1, 1));
    for (const Vector3& value : rigid->metric({})->apply_inverse(p, pulled).value) CHECK(value.allFinite());
  }
}

TEST_CASE("rigid: invalid input is named") {
  Positions rest = random_positions(3, 1);
  rest(1, 2) = NAN;
  CHECK_THROWS_WITH_AS(make_rigid(rest), doctest::Contains("vertex 1"), InputError);
  CHECK_THROWS_AS(make_rigid(random_positions(3, 1))->surface(Controls::Zero(3, 3)), InputError);
}
