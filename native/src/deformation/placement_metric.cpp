// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/placement_metric.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "deformation/checks.hpp"

namespace stiv {

namespace {

class PlacementMetric final : public Metric {
 public:
  PlacementMetric(double centre_factor, PlacementBlock block, Eigen::Vector2d weights)
      : centre_factor_(centre_factor), block_(std::move(block)), weights_(std::move(weights)) {}

  SparseField apply_inverse(const ControlsView& p, const SparseField& g) const override {
    SparseField step;
    for (std::size_t k = 0; k < g.index.size(); ++k) {
      const Index row = g.index[k];
      if (weights_[row] == 0) continue;
      const Vector3 solution =
          row == 0 ? Vector3(g.value[k] / centre_factor_) : Vector3(block_(p).ldlt().solve(g.value[k]));
      step.index.push_back(row);
      step.value.push_back(weights_[row] * solution);
    }
    return step;
  }

  bool is_local() const override { return true; }

 private:
  double centre_factor_;
  PlacementBlock block_;
  Eigen::Vector2d weights_;
};

}  // namespace

std::unique_ptr<Metric> make_placement_metric(Index vertex_count, PlacementBlock block, const MetricOptions& options) {
  const Eigen::Vector2d weights = checked_weights(options, 2);
  const double centre_factor = std::max(vertex_count, Index{1}) * (1 + options.smoothness);
  return std::make_unique<PlacementMetric>(centre_factor, std::move(block), weights);
}

Vector3 placement_damping(const Vector3& diagonal, double smoothness) {
  const double largest = diagonal.maxCoeff();
  if (!(largest > 0)) return Vector3::Ones();
  return smoothness * diagonal.cwiseMax(1e-6 * largest);
}

}  // namespace stiv
