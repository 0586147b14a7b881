// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/metric/column_sums.hpp"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deformation/metric/column_sums.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "vector/doubles-inl.hpp"

#ifndef STIV_COLUMN_SUMS_TYPES
#define STIV_COLUMN_SUMS_TYPES

namespace stiv {

/// Input and output of the sums.
struct ColumnSums {
  const double* matrix;  ///< columns of `rows` numbers each, a multiple of tile_rows
  std::size_t rows;
  const Index* columns;
  const double* values;  ///< (count, 3)
  std::size_t count;
  double* sums;  ///< (rows, 3), column by column
};

constexpr std::size_t tile_rows = 32;  // four vectors of the widest target; a multiple of those of all others

}  // namespace stiv

#endif

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// Keeps the sums of a tile of rows along the three axes in registers, and loops over all columns.
HWY_INLINE void add_tile(const ColumnSums& s, std::size_t row) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  Lanes x[4], y[4], z[4];
  for (std::size_t k = 0; k < 4; ++k) x[k] = y[k] = z[k] = hn::Zero(d);
  for (std::size_t entry = 0; entry < s.count; ++entry) {
    const double* const column = s.matrix + static_cast<std::size_t>(s.columns[entry]) * s.rows + row;
    const double* const value = s.values + 3 * entry;
    const Lanes vx = hn::Set(d, value[0]), vy = hn::Set(d, value[1]), vz = hn::Set(d, value[2]);
    for (std::size_t k = 0; k < 4; ++k) {
      const Lanes some = hn::LoadU(d, column + k * lanes);
      x[k] = hn::Add(x[k], hn::Mul(some, vx));
      y[k] = hn::Add(y[k], hn::Mul(some, vy));
      z[k] = hn::Add(z[k], hn::Mul(some, vz));
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    double* const sums = s.sums + row + k * lanes;
    hn::StoreU(x[k], d, sums);
    hn::StoreU(y[k], d, sums + s.rows);
    hn::StoreU(z[k], d, sums + 2 * s.rows);
  }
}

void add_columns(const ColumnSums& s) {
  for (std::size_t row = 0; row < s.rows; row += 4 * hn::Lanes(Doubles())) add_tile(s, row);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

SummedColumns::SummedColumns(const Eigen::MatrixXd& matrix) : rows_(matrix.rows()) {
  constexpr auto tile = static_cast<Eigen::Index>(tile_rows);
  padded_ = Eigen::MatrixXd::Zero((rows_ + tile - 1) / tile * tile, matrix.cols());
  padded_.topRows(rows_) = matrix;
}

ActiveColumns SummedColumns::sum(const std::vector<Index>& columns, const std::vector<Vector3>& values) const {
  static_assert(sizeof(Vector3) == 3 * sizeof(double));
  ActiveColumns sums(padded_.rows(), 3);
  STIV_FOR_VECTOR_TARGET(add_columns)
  ({padded_.data(), static_cast<std::size_t>(padded_.rows()), columns.data(),
    values.empty() ? nullptr : values.front().data(), columns.size(), sums.data()});
  return sums.topRows(rows_);
}

}  // namespace stiv
#endif
