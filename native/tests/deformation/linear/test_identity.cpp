// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/finite_differences.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

TEST_CASE("identity: derivatives and metric") {
  const auto identity = make_identity(7);
  const Controls p = random_positions(7, 1);
  CHECK(identity->surface(p) == p);
  check_derivatives(*identity, p);
  MetricOptions options;
  check_metric(*identity, p, options, Eigen::VectorXd::Zero(21));
  options.weights.setLinSpaced(7, 0, 3);
  check_metric(*identity, p, options, Eigen::VectorXd::Zero(21));
  for (const bool turned : {false, true})
    check_metric(*identity, p, random_axis_weights(7, 3, turned), Eigen::VectorXd::Zero(21));
}

TEST_CASE("identity: the metric keeps covectors sparse") {
  const auto identity = make_identity(1000);
  const SparseField g{{3, 500}, {Vector3(1, 2, 3), Vector3(4, 5, 6)}};
  const Controls p = Controls::Zero(1000, 3);
  CHECK(identity->pull_back(p, g).index == g.index);
  CHECK(identity->metric({})->apply_inverse(p, g).index == g.index);
}

TEST_CASE("identity: invalid input is named") {
  const auto identity = make_identity(4);
  CHECK_THROWS_WITH_AS(identity->surface(Controls::Zero(5, 3)), doctest::Contains("5 rows"), InputError);
  MetricOptions options;
  options.weights = Eigen::Vector4d(1, 1, -1, 1);
  CHECK_THROWS_WITH_AS(identity->metric(options), doctest::Contains("control 2"), InputError);
  options.weights = Eigen::Vector3d(1, 1, 1);
  CHECK_THROWS_WITH_AS(identity->metric(options), doctest::Contains("3 control weights for 4"), InputError);
  options = random_axis_weights(4, 1, true);
  options.weights[7] = NAN;
  CHECK_THROWS_WITH_AS(identity->metric(options), doctest::Contains("control 2: weight"), InputError);
  options.weights[7] = 1;
  options.weight_axes[3] *= 2;
  CHECK_THROWS_WITH_AS(identity->metric(options), doctest::Contains("control 3: weight axes"), InputError);
  options.weight_axes.resize(2);
  CHECK_THROWS_WITH_AS(identity->metric(options), doctest::Contains("2 weight axes for 4"), InputError);
  CHECK_THROWS_WITH_AS(identity->metric({0.0, {}}), doctest::Contains("smoothness"), InputError);
  CHECK_THROWS_AS(make_identity(-1), InputError);
  CHECK(make_identity(0)->surface(Controls(0, 3)).rows() == 0);
}
