// SPDX-License-Identifier: GPL-3.0-or-later
#include "response/row_projection.hpp"

#include <algorithm>
#include <cmath>

#include "response/sparse_fields.hpp"

namespace stiv {

namespace {

constexpr int max_sweeps = 300;         // of thousands of nearly dependent rows, which hardly ever settle
constexpr int sweeps_per_full_one = 8;  // the others visit only rows with a positive multiplier

void make_as_long(Eigen::VectorXd& multipliers, Eigen::Index size) {
  const Eigen::Index given = std::min(size, multipliers.size());
  multipliers.conservativeResize(size);
  multipliers.head(given) = multipliers.head(given).cwiseMax(0);
  multipliers.tail(size - given).setZero();
}

/// Sparse fields one after another: a sweep reads them in order, and fields of their own are scattered in memory.
class FieldList {
 public:
  FieldList(const std::vector<ControlConstraint>& constraints, SparseField ControlConstraint::*field) {
    std::size_t count = 0;
    for (const ControlConstraint& constraint : constraints) count += (constraint.*field).index.size();
    index_.reserve(count);
    value_.reserve(count);
    end_.reserve(constraints.size());
    for (const ControlConstraint& constraint : constraints) {
      const SparseField& entries = constraint.*field;
      index_.insert(index_.end(), entries.index.begin(), entries.index.end());
      value_.insert(value_.end(), entries.value.begin(), entries.value.end());
      end_.push_back(index_.size());
    }
  }

  double dot(std::size_t field, const Controls& p) const {
    double sum = 0;
    for (std::size_t k = begin(field); k < end_[field]; ++k) sum += value_[k].dot(p.row(index_[k]).transpose());
    return sum;
  }

  void add_scaled(Controls& p, double factor, std::size_t field) const {
    for (std::size_t k = begin(field); k < end_[field]; ++k) p.row(index_[k]) += factor * value_[k].transpose();
  }

 private:
  std::size_t begin(std::size_t field) const { return field == 0 ? 0 : end_[field - 1]; }

  std::vector<Index> index_;
  std::vector<Vector3> value_;
  std::vector<std::size_t> end_;
};

/// Constraints of length 1 in the metric, for sweeps.
class SweptRows {
 public:
  explicit SweptRows(const std::vector<ControlConstraint>& constraints)
      : rows_(constraints, &ControlConstraint::row), steps_(constraints, &ControlConstraint::step) {
    for (const ControlConstraint& constraint : constraints) bounds_.push_back(constraint.bound);
  }

  void move(Controls& p, const Eigen::VectorXd& multipliers) const {
    for (std::size_t r = 0; r < bounds_.size(); ++r) {
      const double multiplier = multipliers[static_cast<Eigen::Index>(r)];
      if (multiplier > 0) steps_.add_scaled(p, multiplier, r);
    }
  }

  /// One sweep over all rows, or those with a positive multiplier. Returns the largest change of a multiplier.
  double sweep(Controls& p, Eigen::VectorXd& multipliers, bool all) const {
    double largest_change = 0;
    for (std::size_t r = 0; r < bounds_.size(); ++r) {
      double& multiplier = multipliers[static_cast<Eigen::Index>(r)];
      if (!all && multiplier == 0) continue;
      const double slack = rows_.dot(r, p) - bounds_[r];
      const double change = std::max(0.0, multiplier - slack) - multiplier;
      if (change == 0) continue;
      multiplier += change;
      steps_.add_scaled(p, change, r);
      largest_change = std::max(largest_change, std::abs(change));
    }
    return largest_change;
  }

 private:
  FieldList rows_, steps_;
  std::vector<double> bounds_;
};

}  // namespace

std::size_t sweep_cost(const std::vector<ControlConstraint>& constraints) {
  std::size_t entries = 0;
  for (const ControlConstraint& constraint : constraints)
    entries += constraint.row.index.size() + constraint.step.index.size();
  return 3 * entries;
}

Controls project_by_rows(const std::vector<ControlConstraint>& constraints, const Controls& from,
                         Eigen::VectorXd& multipliers, const LcpOptions& options) {
  make_as_long(multipliers, static_cast<Eigen::Index>(constraints.size()));
  const SweptRows rows(constraints);
  Controls p = from;
  rows.move(p, multipliers);
  const int most = std::min(options.max_sweeps, max_sweeps);
  bool all = true;
  for (int k = 0; k < most; ++k) {
    if (options.execution != nullptr) options.execution->check();
    all = all || k % sweeps_per_full_one == 0;
    const double change = rows.sweep(p, multipliers, all);
    const bool settled = change <= options.tolerance * (multipliers.size() > 0 ? multipliers.maxCoeff() : 0);
    if (settled && all) break;
    all = settled;
  }
  return p;
}

}  // namespace stiv
