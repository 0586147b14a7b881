// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/linear/linear_metric.hpp"

#include <Eigen/SparseCholesky>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <thread>
#include <utility>

#include "deformation/metric/axis_metric.hpp"
#include "deformation/metric/gram_metric.hpp"
#include "stiv/error.hpp"
#include "stiv/execution.hpp"

namespace stiv {

namespace {

Eigen::VectorXd squared_lengths(const WeightColumns& matrix) {
  Eigen::VectorXd lengths(matrix.cols());
  for (Index control = 0; control < matrix.cols(); ++control) lengths[control] = matrix.col(control).squaredNorm();
  return lengths;
}

WeightColumns selected_columns(const WeightColumns& matrix, const std::vector<Index>& columns) {
  WeightColumns selected(matrix.rows(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    selected.startVec(static_cast<Index>(k));
    for (WeightColumns::InnerIterator entry(matrix, columns[k]); entry; ++entry)
      selected.insertBack(entry.row(), static_cast<Index>(k)) = entry.value();
  }
  selected.finalize();
  return selected;
}

/// M'M summed vertex by vertex into a dense matrix, since the 64 weights of a lattice for each vertex fill it.
Eigen::MatrixXd dense_gram(const WeightColumns& matrix) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor, Index> rows = matrix;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(matrix.cols(), matrix.cols());
  using Entry = Eigen::SparseMatrix<double, Eigen::RowMajor, Index>::InnerIterator;
  for (Index row = 0; row < rows.rows(); ++row)
    for (Entry a(rows, row); a; ++a)
      for (Entry b(rows, row); b && b.col() <= a.col(); ++b) gram(a.col(), b.col()) += a.value() * b.value();
  return gram.selfadjointView<Eigen::Lower>();
}

using Factor = Eigen::SimplicialLDLT<WeightColumns>;
using FutureFactor = std::shared_future<std::shared_ptr<const Factor>>;

constexpr const char* unusable_weights =
    "the metric of the controls cannot be factored: check for very large or very small weights";

/// Factors on a thread of its own: large cages take seconds, and nothing needs the factor before the first contact.
/// The thread owns its matrix, and no one waits for its end if the factor is no longer wanted.
FutureFactor factor_aside(const WeightColumns& damped) {
  std::packaged_task<std::shared_ptr<const Factor>()> task([matrix = damped] {
    const FloatingPointScope floating_point;
    auto factor = std::make_shared<Factor>(matrix);
    if (factor->info() != Eigen::Success) throw InputError(unusable_weights);
    return std::shared_ptr<const Factor>(std::move(factor));
  });
  FutureFactor factor = task.get_future();
  std::thread(std::move(task)).detach();
  return factor;
}

class SparseLinearMetric final : public Metric {
 public:
  SparseLinearMetric(const WeightColumns& matrix, double smoothness, ActiveControls active)
      : active_(std::move(active)) {
    WeightColumns damped = WeightColumns(matrix.transpose()) * matrix;
    const double damping = smoothness * damped.diagonal().mean();
    for (Index k = 0; k < damped.cols(); ++k) damped.coeffRef(k, k) += damping;
    if (!std::isfinite(damped.sum())) throw InputError(unusable_weights);
    factor_ = factor_aside(damped);
  }

  bool is_ready() const override { return factor_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }

  SparseField apply_inverse(const ControlsView&, const SparseField& g) const override {
    const ActiveVector right = restrict_to(active_, g);
    if (right.place.empty()) return {};
    return extend_from(active_, factor_.get()->solve(dense_columns(active_, right)));
  }

 private:
  ActiveControls active_;
  FutureFactor factor_;
};

}  // namespace

LinearMetrics::LinearMetrics(const WeightMatrix& matrix)
    : matrix_(matrix), squared_lengths_(squared_lengths(matrix_)) {}

std::unique_ptr<Metric> LinearMetrics::make(const MetricOptions& options) const {
  const auto of_weights = [&](const Eigen::VectorXd& weights) {
    return make_of_active(options.smoothness, active_controls(squared_lengths_, weights));
  };
  return make_axis_metric(checked_weights(options, static_cast<Index>(matrix_.cols())), of_weights);
}

std::unique_ptr<Metric> LinearMetrics::make_of_active(double smoothness, ActiveControls active) const {
  if (static_cast<Index>(active.control.size()) <= full_inverse_limit) {
    Eigen::MatrixXd gram = gram_of(active.control);
    return make_gram_metric(std::move(gram), smoothness, std::move(active));
  }
  const WeightColumns selected = selected_columns(matrix_, active.control);
  return std::make_unique<SparseLinearMetric>(selected, smoothness, std::move(active));
}

/// Each entry is the same sum, whatever the other controls are.
Eigen::MatrixXd LinearMetrics::gram_of(const std::vector<Index>& controls) const {
  if (matrix_.cols() > full_inverse_limit) return dense_gram(selected_columns(matrix_, controls));
  std::call_once(summed_, [&] {
    const FloatingPointScope floating_point;
    gram_ = dense_gram(matrix_);
  });
  return gram_(controls, controls);
}

}  // namespace stiv
