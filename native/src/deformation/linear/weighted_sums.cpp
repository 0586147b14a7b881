// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/linear/weighted_sums.hpp"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deformation/linear/weighted_sums.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "vector/doubles-inl.hpp"

#ifndef STIV_WEIGHTED_SUMS_TYPES
#define STIV_WEIGHTED_SUMS_TYPES

namespace stiv {

/// Input and output of the product. Rows of `controls` are x, y, z, 0.
struct WeightedSums {
  const Index* starts;  ///< of the entries of each row
  const Index* columns;
  const double* weights;
  const double* controls;
  const Index* rows;  ///< of the sums; null: all
  double* sums;       ///< (rows, 3)
};

}  // namespace stiv

#endif

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

using Coordinates = hn::CappedTag<double, 4>;  // all of a point, or two of them at a time
using Some = hn::Vec<Coordinates>;

HWY_INLINE Some with_entry(const WeightedSums& s, Index entry, std::size_t axis, Some sum) {
  const Coordinates d;
  const double* const control = s.controls + 4 * static_cast<std::ptrdiff_t>(s.columns[entry]) + axis;
  return hn::Add(sum, hn::Mul(hn::Set(d, s.weights[entry]), hn::LoadU(d, control)));
}

/// Four independent sums, so that no addition waits for the previous one.
HWY_INLINE void add_row(const WeightedSums& s, Index place, std::size_t axis) {
  const Coordinates d;
  const Index row = s.rows == nullptr ? place : s.rows[place];
  const Index end = s.starts[row + 1];
  Index entry = s.starts[row];
  Some a = hn::Zero(d), b = a, c = a, e = a;
  for (; entry + 4 <= end; entry += 4) {
    a = with_entry(s, entry, axis, a);
    b = with_entry(s, entry + 1, axis, b);
    c = with_entry(s, entry + 2, axis, c);
    e = with_entry(s, entry + 3, axis, e);
  }
  for (; entry < end; ++entry) a = with_entry(s, entry, axis, a);
  HWY_ALIGN double values[4];
  hn::Store(hn::Add(hn::Add(a, b), hn::Add(c, e)), d, values);
  double* const sums = s.sums + 3 * static_cast<std::ptrdiff_t>(place);
  for (std::size_t k = axis; k < 3 && k < axis + hn::Lanes(d); ++k) sums[k] = values[k - axis];
}

void add_rows(const WeightedSums& s, Index begin, Index end) {
  for (Index place = begin; place < end; ++place)
    for (std::size_t axis = 0; axis < 3; axis += hn::Lanes(Coordinates())) add_row(s, place, axis);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

namespace {

/// Sums of `count` rows: those of `rows`, or all if it is null.
Positions sums_of(const WeightMatrix& matrix, const Index* rows, Index count, const Controls& x,
                  const Execution& execution) {
  constexpr Index rows_per_chunk = 1024;
  using Padded = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
  Padded controls = Padded::Zero(x.rows(), 4);
  controls.leftCols<3>() = x;
  Positions sums(count, 3);
  const WeightedSums s{
      matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr(), controls.data(), rows, sums.data()};
  execution.for_chunks(count, rows_per_chunk, [&](Index begin, Index end, Index) {
    STIV_FOR_VECTOR_TARGET(add_rows)(s, begin, end);
  });
  return sums;
}

}  // namespace

Positions weighted_sums(const WeightMatrix& matrix, const Controls& x, const Execution& execution) {
  return sums_of(matrix, nullptr, static_cast<Index>(matrix.rows()), x, execution);
}

Positions weighted_sums(const WeightMatrix& matrix, std::span<const Index> rows, const Controls& x,
                        const Execution& execution) {
  return sums_of(matrix, rows.data(), static_cast<Index>(rows.size()), x, execution);
}

}  // namespace stiv
#endif
