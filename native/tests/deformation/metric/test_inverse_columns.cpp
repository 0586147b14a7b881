// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <vector>

#include "deformation/metric/inverse_columns.hpp"
#include "stiv/execution.hpp"

using namespace stiv;

namespace {

/// A grid's Laplacian plus the identity, whose inverse decays.
SymmetricMatrix decaying_matrix(Index side) {
  SymmetricMatrix matrix(side * side, side * side);
  std::vector<Eigen::Triplet<double, Index>> entries;
  const auto couple = [&](Index a, Index b) {
    for (const auto& [row, column, value] : {std::tuple{a, b, -0.5}, {b, a, -0.5}, {a, a, 0.5}, {b, b, 0.5}})
      entries.emplace_back(row, column, value);
  };
  for (Index i = 0; i < side; ++i)
    for (Index j = 0; j < side; ++j) {
      entries.emplace_back(i * side + j, i * side + j, 1.0);
      if (i + 1 < side) couple(i * side + j, i * side + j + side);
      if (j + 1 < side) couple(i * side + j, i * side + j + 1);
    }
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

TEST_CASE("inverse columns: those of the dense inverse, whatever the order and the threads that ask") {
  const SymmetricMatrix matrix = decaying_matrix(16);
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(matrix).inverse();
  const auto size = static_cast<Index>(matrix.rows());
  for (const double negligible : {0.0, 1e-4}) {
    const InverseColumns alone(matrix, negligible), shared(matrix, negligible);
    std::size_t entries = 0;
    for (Index k = 0; k < size; ++k) {
      Eigen::VectorXd dense = Eigen::VectorXd::Zero(size);
      const InverseColumns::Column& column = alone.column(k);
      for (std::size_t e = 0; e < column.row.size(); ++e) dense[column.row[e]] = column.value[e];
      CHECK((dense - inverse.col(k)).cwiseAbs().maxCoeff() < (negligible > 0 ? 2e-4 : 1e-13) * inverse(k, k));
      entries += column.row.size();
    }
    CHECK((entries < static_cast<std::size_t>(size) * static_cast<std::size_t>(size) / 2) == (negligible > 0));
    Execution(2).for_chunks(size, 1, [&](Index begin, Index, Index) { shared.column(size - 1 - begin); });
    for (Index k = 0; k < size; ++k) {
      CHECK(alone.column(k).row == shared.column(k).row);
      CHECK(alone.column(k).value == shared.column(k).value);
    }
  }
}
