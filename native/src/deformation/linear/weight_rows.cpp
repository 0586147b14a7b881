// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/linear/weight_rows.hpp"

#include <algorithm>
#include <string>

#include "stiv/error.hpp"

namespace stiv {

namespace {

void check_rows(const std::vector<Index>& starts, const std::vector<Index>& controls, const std::vector<double>& values,
                Index control_count) {
  const auto count = static_cast<Index>(values.size());
  if (control_count < 0) throw InputError("weights: the number of controls is negative");
  if (controls.size() != values.size())
    throw InputError("weights: " + std::to_string(controls.size()) + " control indices for " + std::to_string(count) +
                     " values; give one for each");
  if (starts.empty() || starts.front() != 0 || starts.back() != count)
    throw InputError("weights: the starts of the rows must begin with 0 and end with the number of values, " +
                     std::to_string(count));
  for (std::size_t row = 0; row + 1 < starts.size(); ++row) {
    const std::string name = "weights, row " + std::to_string(row);
    if (starts[row + 1] < starts[row] || starts[row + 1] > count) throw InputError(name + ": ends before it starts");
    for (Index k = starts[row]; k < starts[row + 1]; ++k)
      if (const Index control = controls[at(k)]; control < 0 || control >= control_count)
        throw InputError(name + ": control " + std::to_string(control) + " does not exist; there are " +
                         std::to_string(control_count));
  }
}

}  // namespace

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

WeightMatrix weights_from_rows(const std::vector<Index>& starts, const std::vector<Index>& controls,
                               const std::vector<double>& values, Index control_count) {
  check_rows(starts, controls, values, control_count);
  WeightRows rows(static_cast<Index>(starts.size()) - 1, control_count);
  for (std::size_t row = 0; row + 1 < starts.size(); ++row) {
    for (Index k = starts[row]; k < starts[row + 1]; ++k) rows.add(controls[at(k)], values[at(k)]);
    rows.end_row();
  }
  return rows.matrix();
}

WeightMatrix weight_product(const WeightMatrix& outer, const WeightMatrix& inner) {
  using Entry = WeightMatrix::InnerIterator;
  WeightRows rows(static_cast<Index>(outer.rows()), static_cast<Index>(inner.cols()));
  for (Index row = 0; row < outer.rows(); ++row) {
    for (Entry a(outer, row); a; ++a)
      for (Entry b(inner, a.col()); b; ++b) rows.add(static_cast<Index>(b.col()), a.value() * b.value());
    rows.end_row();
  }
  return rows.matrix();
}

}  // namespace stiv
