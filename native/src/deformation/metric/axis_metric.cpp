// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/metric/axis_metric.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace stiv {

namespace {

/// A metric and its axes.
struct AxisGroup {
  std::unique_ptr<Metric> metric;
  Vector3 mask;  ///< 1 for these axes, 0 for others
};

std::vector<AxisGroup> axis_groups(const Eigen::MatrixXd& weights, const MetricOfWeights& of_weights) {
  std::vector<AxisGroup> groups;
  Vector3 open = Vector3::Ones();
  for (Index axis = 0; axis < 3; ++axis) {
    if (open[axis] == 0) continue;
    Vector3 mask = Vector3::Zero();
    for (Index other = axis; other < 3; ++other)
      if (weights.col(other) == weights.col(axis)) mask[other] = 1;
    open -= mask;
    groups.push_back({of_weights(weights.col(axis)), mask});
  }
  return groups;
}

/// The components of a field along some axes, without zero rows.
SparseField masked(const SparseField& field, const Vector3& mask) {
  SparseField result;
  for (std::size_t k = 0; k < field.index.size(); ++k) {
    const Vector3 value = field.value[k].cwiseProduct(mask);
    if (value.isZero(0)) continue;
    result.index.push_back(field.index[k]);
    result.value.push_back(value);
  }
  return result;
}

SparseField sum(const SparseField& a, const SparseField& b) {
  if (a.index.empty()) return b;
  SparseField result;
  const auto append = [&](Index index, const Vector3& value) {
    result.index.push_back(index);
    result.value.push_back(value);
  };
  std::size_t i = 0, j = 0;
  while (i < a.index.size() || j < b.index.size()) {
    const bool has_a = i < a.index.size(), has_b = j < b.index.size();
    if (has_a && has_b && a.index[i] == b.index[j]) {
      append(a.index[i], a.value[i] + b.value[j]);
      ++i, ++j;
    } else if (has_a && (!has_b || a.index[i] < b.index[j])) {
      append(a.index[i], a.value[i]);
      ++i;
    } else {
      append(b.index[j], b.value[j]);
      ++j;
    }
  }
  return result;
}

class AxisMetric final : public Metric {
 public:
  AxisMetric(std::vector<AxisGroup> groups, std::vector<Eigen::Matrix3d> axes)
      : groups_(std::move(groups)), axes_(std::move(axes)) {}

  SparseField apply_inverse(const ControlsView& p, const SparseField& g) const override {
    SparseField along = g;
    if (!axes_.empty())
      for (std::size_t k = 0; k < along.index.size(); ++k) along.value[k] = axes_of(along, k).transpose() * g.value[k];
    SparseField step;
    for (const AxisGroup& group : groups_)
      step = sum(step, masked(group.metric->apply_inverse(p, masked(along, group.mask)), group.mask));
    if (!axes_.empty())
      for (std::size_t k = 0; k < step.index.size(); ++k) step.value[k] = (axes_of(step, k) * step.value[k]).eval();
    return step;
  }

  bool is_local() const override {
    return std::all_of(groups_.begin(), groups_.end(), [](const auto& group) { return group.metric->is_local(); });
  }

  bool is_ready() const override {
    return std::all_of(groups_.begin(), groups_.end(), [](const auto& group) { return group.metric->is_ready(); });
  }

 private:
  const Eigen::Matrix3d& axes_of(const SparseField& field, std::size_t k) const { return axes_[at(field.index[k])]; }

  std::vector<AxisGroup> groups_;
  std::vector<Eigen::Matrix3d> axes_;
};

}  // namespace

std::unique_ptr<Metric> make_axis_metric(ResponseWeights weights, const MetricOfWeights& of_weights) {
  if (weights.are_uniform()) return of_weights(weights.values.col(0));
  return std::make_unique<AxisMetric>(axis_groups(weights.values, of_weights), std::move(weights.axes));
}

}  // namespace stiv
