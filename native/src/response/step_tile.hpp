// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "stiv/response/resolver.hpp"

namespace stiv {

/// Which controls the rows of some constraints have entries at, numbered from 0: what else steps move does not count
/// in the products of rows and steps.
class RowControls {
 public:
  explicit RowControls(const std::vector<ControlConstraint>& constraints);

  std::size_t count() const { return count_; }
  /// -1: none of the rows has an entry there
  Index number(Index control) const {
    const auto k = static_cast<std::size_t>(control);
    return k < numbers_.size() ? numbers_[k] : -1;
  }

 private:
  std::vector<Index> numbers_;  // by control
  std::size_t count_ = 0;
};

/// Steps of up to `width` constraints side by side, for products with one row after the other: a lane a step.
class StepTile {
 public:
  static constexpr std::size_t width = 32;
  using Products = std::array<double, width>;

  StepTile(std::span<const ControlConstraint> constraints, const RowControls& controls);

  /// row . step of each; products are added up in the order of the row's entries, none fused: the same bits whatever
  /// the width of vectors.
  void multiply(const SparseField& row, Products& products) const;

 private:
  const RowControls& controls_;
  std::vector<double> values_;  // (controls, 3, width)
};

}  // namespace stiv
