// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "stiv/types.hpp"

using namespace stiv;

namespace {

const double* data_of(const PositionsView& view) { return view.data(); }

/// The sum of all numbers, each weighted by its position, in the order of a reader that assumes contiguous rows.
double weighted_sum(const PositionsView& view) {
  double sum = 0;
  for (Index k = 0; k < 3 * view.rows(); ++k) sum += (k + 1) * view.data()[k];
  return sum;
}

}  // namespace

TEST_CASE("positions view: of rows that follow each other without a gap, the very same memory") {
  const Positions q = Positions::Random(7, 3);
  CHECK(data_of(q) == q.data());
  CHECK(data_of(q.middleRows(2, 4)) == q.row(2).data());
  const std::vector<double> numbers(21, 0.5);
  CHECK(data_of(Eigen::Map<const Positions>(numbers.data(), 7, 3)) == numbers.data());
  const PositionsView view = q, of_view = view;
  CHECK(of_view.data() == q.data());
}

TEST_CASE("positions view: of rows with gaps, columns first, or what is still to be computed, a copy without gaps") {
  using Wide = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
  const Wide wide = Wide::Random(7, 4);
  const Positions left = wide.leftCols<3>();
  CHECK(weighted_sum(wide.leftCols<3>()) == weighted_sum(left));
  const Eigen::Matrix<double, Eigen::Dynamic, 3> by_columns = left;
  CHECK(weighted_sum(by_columns) == weighted_sum(left));
  CHECK(weighted_sum(2 * left) == 2 * weighted_sum(left));
  CHECK(PositionsView(Positions(0, 3)).rows() == 0);
}
