// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/weight_rows.hpp"

#include <algorithm>

namespace stiv {

WeightRows::WeightRows(Index row_count, Index control_count)
    : sum_(static_cast<std::size_t>(control_count), 0), in_row_(static_cast<std::size_t>(control_count), 0) {
  starts_.reserve(static_cast<std::size_t>(row_count) + 1);
}

void WeightRows::add(Index control, double weight) {
  const auto k = static_cast<std::size_t>(control);
  if (!in_row_[k]) touched_.push_back(control);
  in_row_[k] = 1;
  sum_[k] += weight;
}

void WeightRows::end_row() {
  std::sort(touched_.begin(), touched_.end());
  for (const Index control : touched_) {
    const auto k = static_cast<std::size_t>(control);
    if (sum_[k] != 0) {
      controls_.push_back(control);
      weights_.push_back(sum_[k]);
    }
    sum_[k] = 0;
    in_row_[k] = 0;
  }
  touched_.clear();
  starts_.push_back(static_cast<Index>(controls_.size()));
}

WeightMatrix WeightRows::matrix() const {
  return Eigen::Map<const WeightMatrix>(static_cast<Index>(starts_.size()) - 1, static_cast<Index>(sum_.size()),
                                        static_cast<Index>(controls_.size()), starts_.data(), controls_.data(),
                                        weights_.data());
}

}  // namespace stiv
