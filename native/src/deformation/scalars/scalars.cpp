// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/scalars.hpp"

#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>

#include "deformation/checks.hpp"
#include "deformation/observed/stored_evaluation.hpp"
#include "deformation/scalars/scalar_metric.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string shape_of(const ScalarJacobian& jacobian) {
  return "(" + std::to_string(jacobian.rows()) + ", " + std::to_string(jacobian.cols()) + ")";
}

std::shared_ptr<const ScalarJacobian> checked(ScalarJacobian jacobian) {
  if (jacobian.rows() % 3 != 0)
    throw InputError("jacobian: its shape is " + shape_of(jacobian) + "; give three rows for each vertex");
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row)
    if (!jacobian.row(row).allFinite())
      throw InputError("jacobian, vertex " + std::to_string(row / 3) + ": a number is not finite");
  return std::make_shared<ScalarJacobian>(std::move(jacobian));
}

Eigen::VectorXd of_size(Eigen::VectorXd values, Index count, double none, const char* name) {
  if (values.size() == 0) return Eigen::VectorXd::Constant(count, none);
  if (values.size() != count)
    throw InputError(std::string(name) + ": there are " + std::to_string(values.size()) + " values for " +
                     std::to_string(count) + " scalars");
  return values;
}

ScalarLimits checked(ScalarLimits limits, Index count) {
  limits.lower = of_size(std::move(limits.lower), count, -infinity, "lower");
  limits.upper = of_size(std::move(limits.upper), count, infinity, "upper");
  limits.longest_step = of_size(std::move(limits.longest_step), count, infinity, "longest_step");
  for (Index k = 0; k < count; ++k) {
    const std::string name = "scalar " + std::to_string(k);
    if (!(limits.lower[k] <= limits.upper[k] && limits.lower[k] < infinity && limits.upper[k] > -infinity))
      throw InputError(name + ": its limits " + std::to_string(limits.lower[k]) + " to " +
                       std::to_string(limits.upper[k]) + " contain no number");
    if (!(limits.longest_step[k] > 0)) throw InputError(name + ": longest_step must be positive");
  }
  return limits;
}

Evaluation of_controls(ScalarEvaluation evaluate) {
  return [evaluate = std::move(evaluate)](const Controls& p) { return evaluate(p.col(0)); };
}

class Scalars final : public ScalarDeformation {
 public:
  Scalars(ScalarEvaluation evaluate, ScalarJacobian jacobian, ScalarLimits limits)
      : jacobian_(checked(std::move(jacobian))),
        count_(static_cast<Index>(jacobian_->cols())),
        vertex_count_(static_cast<Index>(jacobian_->rows() / 3)),
        limits_(checked(std::move(limits), count_)),
        evaluation_(of_controls(std::move(evaluate)), vertex_count_) {}

  Index control_count() const override { return count_; }
  Index vertex_count() const override { return vertex_count_; }

  Positions surface(const Controls& p, const Execution& execution) const override {
    check_control_rows(p, count_);
    return evaluation_.surface(p, execution);
  }

  SparseField pull_back(const ControlsView&, const SparseField& g) const override {
    const std::shared_ptr<const ScalarJacobian> jacobian = now();
    Eigen::RowVectorXd sums = Eigen::RowVectorXd::Zero(count_);
    for (std::size_t k = 0; k < g.index.size(); ++k)
      for (Index axis = 0; axis < 3; ++axis) sums += g.value[k][axis] * jacobian->row(3 * g.index[k] + axis);
    SparseField pulled;
    for (Index k = 0; k < count_; ++k) {
      if (sums[k] == 0) continue;
      pulled.index.push_back(k);
      pulled.value.emplace_back(sums[k], 0, 0);
    }
    return pulled;
  }

  Positions push_forward(const Controls&, const Controls& d) const override {
    check_control_rows(d, count_);
    const Eigen::VectorXd velocity = *now() * d.col(0);
    return Eigen::Map<const Positions>(velocity.data(), vertex_count_, 3);
  }

  std::vector<Index> support(Index control) const override {
    const std::shared_ptr<const ScalarJacobian> jacobian = now();
    std::vector<Index> vertices;
    for (Index vertex = 0; vertex < vertex_count_; ++vertex)
      if (!jacobian->block<3, 1>(3 * vertex, control).isZero(0)) vertices.push_back(vertex);
    return vertices;
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    const std::shared_ptr<const ScalarJacobian> jacobian = now();
    return make_scalar_metric(jacobian->transpose() * *jacobian, options);
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    const std::shared_ptr<const ScalarJacobian> jacobian = now();
    const Eigen::Map<const ScalarJacobian> by_vertex(jacobian->data(), vertex_count_, 3 * jacobian->cols());
    const ScalarJacobian products = surface_gram * by_vertex;
    const Eigen::Map<const ScalarJacobian> by_coordinate(products.data(), jacobian->rows(), jacobian->cols());
    return make_scalar_metric(jacobian->transpose() * by_coordinate, options);
  }

  void set_jacobian(ScalarJacobian jacobian) override {
    if (jacobian.rows() != 3 * vertex_count_ || jacobian.cols() != count_)
      throw InputError("jacobian: its shape is " + shape_of(jacobian) + ", expected (" +
                       std::to_string(3 * vertex_count_) + ", " + std::to_string(count_) + ")");
    std::shared_ptr<const ScalarJacobian> next = checked(std::move(jacobian));
    const std::lock_guard lock(mutex_);
    jacobian_ = std::move(next);
    ++revision_;
  }

  std::uint64_t revision() const override {
    const std::lock_guard lock(mutex_);
    return revision_;
  }

  ScalarRows scalar_rows() const override {
    ScalarRows scalars{std::vector<Index>(at(count_)), limits_};
    std::iota(scalars.rows.begin(), scalars.rows.end(), 0);
    return scalars;
  }

 private:
  std::shared_ptr<const ScalarJacobian> now() const {
    const std::lock_guard lock(mutex_);
    return jacobian_;
  }

  std::shared_ptr<const ScalarJacobian> jacobian_;
  Index count_, vertex_count_;
  ScalarLimits limits_;
  StoredEvaluation evaluation_;
  std::uint64_t revision_ = 0;
  mutable std::mutex mutex_;  ///< of J
};

}  // namespace

std::shared_ptr<ScalarDeformation> make_scalars(ScalarEvaluation evaluate, ScalarJacobian jacobian,
                                                ScalarLimits limits) {
  return std::make_shared<Scalars>(std::move(evaluate), std::move(jacobian), std::move(limits));
}

}  // namespace stiv
