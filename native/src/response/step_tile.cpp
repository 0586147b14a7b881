// SPDX-License-Identifier: GPL-3.0-or-later
#include "response/step_tile.hpp"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "response/step_tile.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "vector/doubles-inl.hpp"

#ifndef STIV_STEP_TILE_TYPES
#define STIV_STEP_TILE_TYPES

namespace stiv {

/// A row and the tile that it is multiplied with.
struct TileProduct {
  const double* const* lines;  ///< for each entry, its control's rows of the tile, (3, width)
  const double* values;        ///< (entries, 3)
  std::size_t entries;
  double* products;  ///< (width)
};

}  // namespace stiv

#endif

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// Keeps four vectors of products in registers, and loops over the entries.
HWY_INLINE void multiply_lanes(const TileProduct& p, std::size_t lane) {
  constexpr std::size_t width = StepTile::width;
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  Lanes sum[4];
  for (std::size_t k = 0; k < 4; ++k) sum[k] = hn::Zero(d);
  for (std::size_t entry = 0; entry < p.entries; ++entry) {
    const double* const line = p.lines[entry] + lane;
    const double* const value = p.values + 3 * entry;
    const Lanes x = hn::Set(d, value[0]), y = hn::Set(d, value[1]), z = hn::Set(d, value[2]);
    for (std::size_t k = 0; k < 4; ++k) {
      const double* const some = line + k * lanes;
      const Lanes along_x = hn::Mul(x, hn::LoadU(d, some)), along_y = hn::Mul(y, hn::LoadU(d, some + width));
      const Lanes along_z = hn::Mul(z, hn::LoadU(d, some + 2 * width));
      sum[k] = hn::Add(sum[k], hn::Add(hn::Add(along_x, along_y), along_z));
    }
  }
  for (std::size_t k = 0; k < 4; ++k) hn::StoreU(sum[k], d, p.products + lane + k * lanes);
}

void multiply_tile(const TileProduct& p) {
  for (std::size_t lane = 0; lane < StepTile::width; lane += 4 * hn::Lanes(Doubles())) multiply_lanes(p, lane);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

RowControls::RowControls(const std::vector<ControlConstraint>& constraints) {
  for (const ControlConstraint& constraint : constraints) {
    const std::vector<Index>& controls = constraint.row.index;
    if (controls.empty()) continue;
    if (numbers_.size() <= static_cast<std::size_t>(controls.back()))
      numbers_.resize(static_cast<std::size_t>(controls.back()) + 1, -1);
    for (const Index control : controls) {
      Index& number = numbers_[at(control)];
      if (number < 0) number = static_cast<Index>(count_++);
    }
  }
}

StepTile::StepTile(std::span<const ControlConstraint> constraints, const RowControls& controls)
    : controls_(controls), values_(3 * width * controls.count(), 0) {
  for (std::size_t lane = 0; lane < constraints.size(); ++lane) {
    const SparseField& step = constraints[lane].step;
    for (std::size_t k = 0; k < step.index.size(); ++k) {
      const Index number = controls.number(step.index[k]);
      if (number < 0) continue;
      double* const line = values_.data() + 3 * width * static_cast<std::size_t>(number) + lane;
      for (std::size_t axis = 0; axis < 3; ++axis) line[axis * width] = step.value[k][static_cast<Index>(axis)];
    }
  }
}

void StepTile::multiply(const SparseField& row, Products& products) const {
  static_assert(sizeof(Vector3) == 3 * sizeof(double));
  std::vector<const double*> lines;
  lines.reserve(row.index.size());
  for (const Index control : row.index)
    lines.push_back(values_.data() + 3 * width * static_cast<std::size_t>(controls_.number(control)));
  STIV_FOR_VECTOR_TARGET(multiply_tile)
  ({lines.data(), row.value.empty() ? nullptr : row.value.front().data(), lines.size(), products.data()});
}

}  // namespace stiv
#endif
