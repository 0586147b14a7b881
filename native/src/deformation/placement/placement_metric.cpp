// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/placement/placement_metric.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>
#include <vector>

#include "deformation/checks.hpp"

namespace stiv {

namespace {

/// W^1/2 B^-1 W^1/2 g for the axes with w > 0, 0 for the others.
Vector3 step_of_block(const Eigen::Matrix3d& block, const Vector3& weights, const Vector3& g) {
  std::vector<Index> free;
  for (Index axis = 0; axis < 3; ++axis)
    if (weights[axis] > 0) free.push_back(axis);
  const Eigen::VectorXd roots = weights(free).cwiseSqrt();
  const Eigen::MatrixXd free_block = block(free, free);
  const Eigen::VectorXd right = roots.cwiseProduct(g(free));
  Vector3 step = Vector3::Zero();
  step(free) = roots.cwiseProduct(free_block.ldlt().solve(right));
  return step;
}

class PlacementMetric final : public Metric {
 public:
  PlacementMetric(double centre_factor, PlacementBlock block, ResponseWeights weights)
      : centre_factor_(centre_factor), block_(std::move(block)), weights_(std::move(weights)) {}

  SparseField apply_inverse(const ControlsView& p, const SparseField& g) const override {
    SparseField step;
    for (std::size_t k = 0; k < g.index.size(); ++k) {
      const Index row = g.index[k];
      if (weights_.values.row(row).isZero(0)) continue;
      step.index.push_back(row);
      step.value.push_back(weights_.are_uniform() ? uniform_step(p, row, g.value[k]) : axis_step(p, row, g.value[k]));
    }
    return step;
  }

  bool is_local() const override { return true; }

 private:
  Vector3 uniform_step(const ControlsView& p, Index row, const Vector3& g) const {
    const Vector3 solution = row == 0 ? Vector3(g / centre_factor_) : Vector3(block_(p).ldlt().solve(g));
    return weights_.values(row, 0) * solution;
  }

  Vector3 axis_step(const ControlsView& p, Index row, const Vector3& g) const {
    const Eigen::Matrix3d axes = weights_.axes.empty() ? Eigen::Matrix3d::Identity() : weights_.axes[at(row)];
    const Vector3 along = axes.transpose() * g, weights = weights_.values.row(row);
    const Vector3 step = row == 0 ? Vector3(weights.cwiseProduct(along) / centre_factor_)
                                  : step_of_block(axes.transpose() * block_(p) * axes, weights, along);
    return weights_.axes.empty() ? step : Vector3(axes * step);
  }

  double centre_factor_;
  PlacementBlock block_;
  ResponseWeights weights_;
};

}  // namespace

std::unique_ptr<Metric> make_placement_metric(Index vertex_count, PlacementBlock block, const MetricOptions& options) {
  ResponseWeights weights = checked_weights(options, 2);
  const double centre_factor = std::max(vertex_count, Index{1}) * (1 + options.smoothness);
  return std::make_unique<PlacementMetric>(centre_factor, std::move(block), std::move(weights));
}

Vector3 placement_damping(const Vector3& diagonal, double smoothness) {
  const double largest = diagonal.maxCoeff();
  if (!(largest > 0)) return Vector3::Ones();
  return smoothness * diagonal.cwiseMax(1e-6 * largest);
}

}  // namespace stiv
