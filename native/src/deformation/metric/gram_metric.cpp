// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/metric/gram_metric.hpp"

#include <Eigen/Cholesky>
#include <utility>

#include "deformation/metric/column_sums.hpp"

namespace stiv {

namespace {

class InverseMetric final : public Metric {
 public:
  InverseMetric(const Eigen::MatrixXd& damped, ActiveControls active)
      : active_(std::move(active)),
        inverse_(damped.llt().solve(Eigen::MatrixXd::Identity(damped.rows(), damped.cols()))) {}

  SparseField apply_inverse(const ControlsView&, const SparseField& g) const override {
    const ActiveVector right = restrict_to(active_, g);
    if (right.place.empty()) return {};
    return extend_from(active_, inverse_.sum(right.place, right.value));
  }

 private:
  ActiveControls active_;
  SummedColumns inverse_;
};

class FactoredMetric final : public Metric {
 public:
  FactoredMetric(const Eigen::MatrixXd& damped, ActiveControls active) : active_(std::move(active)), factor_(damped) {}

  SparseField apply_inverse(const ControlsView&, const SparseField& g) const override {
    const ActiveVector right = restrict_to(active_, g);
    if (right.place.empty()) return {};
    return extend_from(active_, factor_.solve(dense_columns(active_, right)));
  }

 private:
  ActiveControls active_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace

std::unique_ptr<Metric> make_gram_metric(Eigen::MatrixXd gram, double smoothness, ActiveControls active) {
  if (gram.rows() > 0) gram.diagonal().array() += smoothness * gram.diagonal().mean();
  if (gram.rows() <= full_inverse_limit) return std::make_unique<InverseMetric>(gram, std::move(active));
  return std::make_unique<FactoredMetric>(gram, std::move(active));
}

}  // namespace stiv
