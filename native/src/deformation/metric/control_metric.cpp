// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "deformation/metric/axis_metric.hpp"
#include "deformation/metric/gram_metric.hpp"
#include "stiv/deformation/metric.hpp"

namespace stiv {

namespace {

/// M^-1 = W, so a step is as sparse as its covector.
class ControlMetric final : public Metric {
 public:
  ControlMetric(Eigen::VectorXd weights, bool local) : weights_(std::move(weights)), local_(local) {}

  SparseField apply_inverse(const ControlsView&, const SparseField& g) const override {
    SparseField step;
    for (std::size_t k = 0; k < g.index.size(); ++k) {
      const double weight = weights_[g.index[k]];
      if (weight == 0) continue;
      step.index.push_back(g.index[k]);
      step.value.push_back(weight * g.value[k]);
    }
    return step;
  }

  bool is_local() const override { return local_; }

 private:
  Eigen::VectorXd weights_;
  bool local_;
};

}  // namespace

std::unique_ptr<Metric> make_diagonal_metric(const Eigen::VectorXd& diagonal, double smoothness,
                                             const ActiveControls& active) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(diagonal.size());
  if (active.control.empty()) return std::make_unique<ControlMetric>(std::move(weights), false);
  const double damping = smoothness * diagonal(active.control).mean();
  for (std::size_t k = 0; k < active.control.size(); ++k) {
    const Index control = active.control[k];
    weights[control] = active.root_weight[k] * active.root_weight[k] / (diagonal[control] + damping);
  }
  return std::make_unique<ControlMetric>(std::move(weights), false);
}

std::unique_ptr<Metric> make_control_metric(const MetricOptions& options, Index control_count, ControlSupport support) {
  return make_axis_metric(checked_weights(options, control_count), [&](const Eigen::VectorXd& weights) {
    return std::make_unique<ControlMetric>(weights, support == ControlSupport::disjoint);
  });
}

}  // namespace stiv
