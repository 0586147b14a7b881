// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// Builds a weight matrix row by row. Repeated weights of a control add up in the order given; sums of exactly 0 are
/// left out.
class WeightRows {
 public:
  WeightRows(Index row_count, Index control_count);

  void add(Index control, double weight);
  void end_row();

  /// The matrix of the completed rows.
  WeightMatrix matrix() const;

 private:
  std::vector<double> sum_;            ///< of the row being built, by control
  std::vector<unsigned char> in_row_;  ///< by control: 1 if it has a sum in this row
  std::vector<Index> touched_;         ///< controls with a sum in this row
  std::vector<Index> starts_{0}, controls_;
  std::vector<double> weights_;
};

/// Weights of outer(inner(p)).
WeightMatrix weight_product(const WeightMatrix& outer, const WeightMatrix& inner);

}  // namespace stiv
