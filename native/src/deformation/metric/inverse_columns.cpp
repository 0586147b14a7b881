// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/metric/inverse_columns.hpp"

#include <algorithm>

namespace stiv {

namespace {

constexpr Index width = ColumnBlock::ColsAtCompileTime;

}  // namespace

InverseColumns::InverseColumns(const SymmetricMatrix& matrix, double negligible)
    : factor_(matrix, "the metric of the controls cannot be factored: check for very large or very small derivatives"),
      solver_(factor_, negligible),
      computed_(static_cast<std::size_t>((matrix.rows() + width - 1) / width)),
      columns_(static_cast<std::size_t>(matrix.rows())) {}

/// Columns are grouped by their places in the factor, whose neighbors are close to each other.
const InverseColumns::Column& InverseColumns::column(Index k) const {
  const Index group = factor_.place(k) / width;
  std::call_once(computed_[at(group)], [&] { compute(group); });
  return columns_[at(k)];
}

void InverseColumns::compute(Index group) const {
  const Index first = width * group, count = std::min(width, factor_.size() - first);
  std::vector<BlockRow> right(static_cast<std::size_t>(count));
  for (Index lane = 0; lane < count; ++lane) {
    right[at(lane)].row = factor_.row(first + lane);
    right[at(lane)].values.setZero();
    right[at(lane)].values[lane] = 1;
  }
  std::vector<BlockRow> rows;
  {
    const std::lock_guard lock(solving_);
    rows = solver_.solve(right);
  }
  for (const BlockRow& row : rows)
    for (Index lane = 0; lane < count; ++lane) {
      if (row.values[lane] == 0) continue;
      Column& column = columns_[at(right[at(lane)].row)];
      column.row.push_back(row.row);
      column.value.push_back(row.values[lane]);
    }
}

}  // namespace stiv
