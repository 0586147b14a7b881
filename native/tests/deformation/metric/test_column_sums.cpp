// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "deformation/metric/column_sums.hpp"
#include "vector_targets.hpp"

using namespace stiv;

TEST_CASE("column sums: those of the matrix, the same bits for every vector target") {
  std::srand(2);
  for (const Index size : {1, 31, 64, 100}) {
    const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(size, size);
    const SummedColumns summed(matrix);
    for (const Index count : {0, 1, 5, 40}) {
      std::vector<Index> columns;
      std::vector<Vector3> values;
      ActiveColumns expected = ActiveColumns::Zero(size, 3);
      for (Index k = 0; k < count; ++k) {
        columns.push_back(7 * k % size);
        values.push_back(Vector3::Random());
        expected += matrix.col(columns.back()) * values.back().transpose();
      }
      const auto results = for_each_vector_target([&] { return summed.sum(columns, values); });
      for (const ActiveColumns& result : results) CHECK(result == results.front());
      CHECK((results.front() - expected).norm() <= 1e-13 * expected.norm());
    }
  }
}
