// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "stiv/response/resolver.hpp"

namespace stiv {

/// The controls of the rows of some constraints, numbered from 0. Products of rows and steps need no others.
class RowControls {
 public:
  explicit RowControls(const std::vector<ControlConstraint>& constraints);

  std::size_t count() const { return count_; }
  /// The number of a control, -1 if no row has an entry there.
  Index number(Index control) const {
    const auto k = static_cast<std::size_t>(control);
    return k < numbers_.size() ? numbers_[k] : -1;
  }

 private:
  std::vector<Index> numbers_;  // by control
  std::size_t count_ = 0;
};

/// Steps of up to `width` constraints side by side, one in each lane, for products with many rows.
class StepTile {
 public:
  static constexpr std::size_t width = 32;
  using Products = std::array<double, width>;

  StepTile(std::span<const ControlConstraint> constraints, const RowControls& controls);

  /// row . step for each step. Terms are added in the order of the row's entries, none fused: same bits for any vector
  /// width.
  void multiply(const SparseField& row, Products& products) const;

 private:
  const RowControls& controls_;
  std::vector<double> values_;  // (controls, 3, width)
};

}  // namespace stiv
