// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/scalars/scalar_metric.hpp"

#include <Eigen/Cholesky>
#include <utility>
#include <vector>

#include "deformation/checks.hpp"

namespace stiv {

namespace {

class ScalarMetric final : public Metric {
 public:
  explicit ScalarMetric(Eigen::MatrixXd inverse) : inverse_(std::move(inverse)) {}

  SparseField apply_inverse(const ControlsView&, const SparseField& g) const override {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(inverse_.rows());
    for (std::size_t k = 0; k < g.index.size(); ++k) x += inverse_.col(g.index[k]) * g.value[k].x();
    SparseField step;
    for (Index row = 0; row < x.size(); ++row) {
      if (x[row] == 0) continue;
      step.index.push_back(row);
      step.value.emplace_back(x[row], 0, 0);
    }
    return step;
  }

 private:
  Eigen::MatrixXd inverse_;
};

}  // namespace

std::unique_ptr<Metric> make_scalar_metric(const Eigen::MatrixXd& gram, const MetricOptions& options) {
  const auto count = static_cast<Index>(gram.rows());
  const Eigen::VectorXd weights = checked_weights(options, count).values.col(0);
  std::vector<Index> active;
  for (Index k = 0; k < count; ++k)
    if (weights[k] > 0 && gram(k, k) > 0) active.push_back(k);
  const Eigen::VectorXd speeds = gram.diagonal()(active).cwiseSqrt();
  Eigen::MatrixXd damped = gram(active, active);
  damped = speeds.cwiseInverse().asDiagonal() * damped * speeds.cwiseInverse().asDiagonal();
  damped.diagonal().array() += options.smoothness;
  const Eigen::VectorXd scale = Eigen::VectorXd(weights(active)).cwiseSqrt().cwiseQuotient(speeds);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(damped.rows(), damped.cols());
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(count, count);
  inverse(active, active) = scale.asDiagonal() * damped.llt().solve(identity) * scale.asDiagonal();
  return std::make_unique<ScalarMetric>(std::move(inverse));
}

}  // namespace stiv
