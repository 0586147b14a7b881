// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/finite_differences.hpp"
#include "stiv/deformation/combination.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

WeightMatrix sparse(const Eigen::MatrixXd& matrix) {
  WeightMatrix weights = matrix.sparseView();
  return weights;
}

}  // namespace

TEST_CASE("composition: equals both deformations in sequence") {
  const Positions values = random_positions(12, 1);
  const Eigen::MatrixXd inner_matrix = values.topRows(4), outer_matrix = values.bottomRows(4).transpose();
  const auto inner = make_linear(sparse(inner_matrix), random_positions(4, 2));
  const auto outer = make_linear(sparse(outer_matrix));
  const auto chain = make_composition(*outer, *inner);
  const Controls p = random_positions(3, 3);
  CHECK((chain->surface(p) - outer->surface(inner->surface(p))).norm() < 1e-14);
  CHECK(Eigen::MatrixXd(chain->weights()).isApprox(outer_matrix * inner_matrix));
  check_derivatives(*chain, p);
  CHECK(make_composition(*outer, *make_linear(sparse(inner_matrix)))->offset().rows() == 0);
  CHECK_THROWS_WITH_AS(make_composition(*outer, *outer), doctest::Contains("4 controls"), InputError);
}

TEST_CASE("weights from rows: summed, sorted, checked") {
  const WeightMatrix weights = weights_from_rows({0, 3, 3, 4}, {2, 0, 2, 1}, {1, 2, 3, 4}, 3);
  Eigen::MatrixXd expected(3, 3);
  expected << 2, 0, 4, 0, 0, 0, 0, 4, 0;
  CHECK(Eigen::MatrixXd(weights) == expected);
  CHECK_THROWS_WITH_AS(weights_from_rows({0, 1}, {3}, {1}, 3), doctest::Contains("row 0: control 3"), InputError);
  CHECK_THROWS_WITH_AS(weights_from_rows({0, 2, 1}, {0}, {1}, 3), doctest::Contains("row 0"), InputError);
  CHECK_THROWS_WITH_AS(weights_from_rows({0, 2}, {0}, {1}, 3), doctest::Contains("starts"), InputError);
  CHECK_THROWS_WITH_AS(weights_from_rows({0, 1}, {0, 1}, {1}, 3), doctest::Contains("2 control indices"), InputError);
}
