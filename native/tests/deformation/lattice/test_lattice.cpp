// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/finite_differences.hpp"
#include "stiv/deformation/lattice.hpp"
#include "stiv/error.hpp"
#include "vector_targets.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

const LatticeInterpolation kinds[] = {LatticeInterpolation::linear, LatticeInterpolation::cardinal,
                                      LatticeInterpolation::catmull_rom, LatticeInterpolation::bspline};

/// Points at a spacing of 1, starting at the origin.
LatticeDefinition unit_lattice(std::array<Index, 3> resolution, LatticeInterpolation kind) {
  LatticeDefinition lattice{
      resolution, {kind, kind, kind}, Positions(resolution[0] * resolution[1] * resolution[2], 3), {}};
  Index point = 0;
  for (Index w = 0; w < resolution[2]; ++w)
    for (Index v = 0; v < resolution[1]; ++v)
      for (Index u = 0; u < resolution[0]; ++u) lattice.rest.row(point++) << u, v, w;
  return lattice;
}

}  // namespace

TEST_CASE("lattice: weights sum to 1, inside and far outside") {
  Positions places = 3 * random_positions(20, 1);
  places.row(19) << 1e12, -1e12, 1e300;
  for (const LatticeInterpolation kind : kinds)
    for (const std::array<Index, 3>& resolution : {std::array<Index, 3>{4, 3, 5}, {1, 2, 1}}) {
      const WeightMatrix weights = lattice_weights(unit_lattice(resolution, kind), places);
      CHECK((weights * Eigen::VectorXd::Ones(weights.cols()) - Eigen::VectorXd::Ones(20)).cwiseAbs().maxCoeff() <
            1e-12);
    }
}

TEST_CASE("lattice: at a point, B-splines weigh neighbours (1, 4, 1) / 6, the others pass through it") {
  Positions place(1, 3);
  place << 2, 0, 0;
  for (const LatticeInterpolation kind : kinds) {
    const Eigen::MatrixXd weights = lattice_weights(unit_lattice({5, 1, 1}, kind), place);
    const Eigen::RowVectorXd expected =
        kind == LatticeInterpolation::bspline
            ? Eigen::RowVectorXd((Eigen::RowVectorXd(5) << 0, 1, 4, 1, 0).finished() / 6)
            : Eigen::RowVectorXd::Unit(5, 2);
    CHECK((weights.row(0) - expected).norm() < 1e-15);
  }
}

TEST_CASE("lattice: influence scales rows, twice if the lattice has point weights") {
  LatticeDefinition lattice = unit_lattice({3, 3, 3}, LatticeInterpolation::bspline);
  const Positions places = random_positions(6, 2);
  const Eigen::MatrixXd plain = lattice_weights(lattice, places);
  const Eigen::VectorXd influence = Eigen::VectorXd::LinSpaced(6, 0, 1);
  CHECK(Eigen::MatrixXd(lattice_weights(lattice, places, influence)).isApprox(influence.asDiagonal() * plain));
  lattice.point_weights = Eigen::VectorXd::LinSpaced(27, 0, 1);
  const Eigen::VectorXd factor = influence.array().square() * (plain * lattice.point_weights).array();
  CHECK(Eigen::MatrixXd(lattice_weights(lattice, places, influence)).isApprox(factor.asDiagonal() * plain));
}

TEST_CASE("lattice: the deformation is that of its weights, the same bits for any target and number of threads") {
  Positions places = 3 * random_positions(5000, 3);
  places.row(0) << 1e12, -1e12, 1e300;
  const Positions vertices = random_positions(5000, 4);
  for (const LatticeInterpolation kind : kinds)
    for (const std::array<Index, 3>& resolution : {std::array<Index, 3>{4, 3, 5}, {1, 2, 1}}) {
      LatticeDefinition lattice = unit_lattice(resolution, kind);
      const auto count = static_cast<Index>(lattice.rest.rows());
      lattice.point_weights = Eigen::VectorXd::LinSpaced(count, 0.2, 1);
      const Eigen::VectorXd influence = Eigen::VectorXd::LinSpaced(5000, 0, 1);
      const Controls rest = random_positions(count, 5), p = random_positions(count, 6), d = random_positions(count, 7);
      const auto deformation = make_lattice(lattice, {places, influence, vertices, rest});
      const WeightMatrix weights = lattice_weights(lattice, places, influence);
      const Positions expected = vertices + weights * (p - rest), q = deformation->surface(p);
      CHECK((q - expected).cwiseAbs().maxCoeff() < 1e-13);
      CHECK((deformation->surface(rest) - vertices).cwiseAbs().maxCoeff() < 1e-14);
      CHECK((deformation->push_forward(p, d) - weights * d).cwiseAbs().maxCoeff() < 1e-13);
      for (const Positions& other : for_each_vector_target([&] { return deformation->surface(p, Execution(3)); }))
        CHECK(other == q);
      check_rows(*deformation, p);
    }
}

TEST_CASE("lattice: invalid input is named") {
  LatticeDefinition lattice = unit_lattice({3, 3, 3}, LatticeInterpolation::bspline);
  const Positions places = random_positions(6, 2);
  CHECK_THROWS_WITH_AS(lattice_weights(lattice, places, Eigen::VectorXd::Ones(5)), doctest::Contains("5 values for 6"),
                       InputError);
  lattice.rest(4, 1) = NAN;
  CHECK_THROWS_WITH_AS(lattice_weights(lattice, places), doctest::Contains("point 4"), InputError);
  lattice.rest.setZero();
  CHECK_THROWS_WITH_AS(lattice_weights(lattice, places), doctest::Contains("coincide along axis 0"), InputError);
  lattice.resolution = {3, 0, 3};
  CHECK_THROWS_WITH_AS(lattice_weights(lattice, places), doctest::Contains("resolution"), InputError);
}
