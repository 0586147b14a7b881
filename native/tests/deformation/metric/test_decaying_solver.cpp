// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/metric/decaying_solver.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>

using namespace stiv;

namespace {

/// The squared Laplacian of a grid, and a stronger or weaker diagonal: solutions decay within a few cells.
SymmetricMatrix grid_equations(Index side) {
  std::vector<Eigen::Triplet<double, Index>> entries;
  const auto connect = [&](Index a, Index b) {
    for (const auto& [row, column, value] : {std::tuple(a, a, 1.0), {b, b, 1.0}, {a, b, -1.0}, {b, a, -1.0}})
      entries.emplace_back(row, column, value);
  };
  for (Index i = 0; i < side; ++i)
    for (Index j = 0; j < side; ++j) {
      if (i + 1 < side) connect(i * side + j, (i + 1) * side + j);
      if (j + 1 < side) connect(i * side + j, i * side + j + 1);
    }
  SymmetricMatrix laplacian(side * side, side * side), diagonal(side * side, side * side);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  diagonal.setIdentity();
  for (Index k = 0; k < side * side; ++k) diagonal.coeffRef(k, k) = 1 + 0.5 * std::sin(k);
  return SymmetricMatrix(laplacian * laplacian) + diagonal;
}

}  // namespace

TEST_CASE("decaying solver: what it leaves out is negligible, and the rest is the dense solution") {
  constexpr Index side = 40, size = side * side;
  const SymmetricMatrix matrix = grid_equations(side);
  const SparseFactor factor(matrix, "test");
  const Eigen::LLT<Eigen::MatrixXd> dense{Eigen::MatrixXd(matrix)};
  for (const double negligible : {1e-2, 1e-5}) {
    DecayingSolver solver(factor, negligible);
    std::size_t rows_of_all = 0;
    for (const Index corner : {0, 500, size - 3 * side}) {  // the solver is reused
      std::vector<BlockRow> right;
      Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(size, 16), found = expected;
      for (const Index row : {corner, corner + 1, corner + side, corner}) {
        right.emplace_back().row = row;
        right.back().values.setRandom();
        right.back().values[15] = 0;
        expected.row(row) += right.back().values.matrix();
      }
      expected = dense.solve(expected).eval();
      const std::vector<BlockRow> rows = solver.solve(right);
      for (const BlockRow& row : rows) found.row(row.row) = row.values.matrix();
      rows_of_all += rows.size();
      const Eigen::RowVectorXd largest = expected.cwiseAbs().colwise().maxCoeff();
      CHECK(((expected - found).cwiseAbs().colwise().maxCoeff().array() <= 1.5 * negligible * largest.array()).all());
      const auto stored = found.array() != 0;
      CHECK((stored.select(expected - found, 0).cwiseAbs().maxCoeff()) <= negligible * largest.maxCoeff());
      CHECK(found.col(15).isZero(0));
    }
    CHECK(rows_of_all < 3 * size / (negligible < 1e-3 ? 3 : 12));
  }
}
