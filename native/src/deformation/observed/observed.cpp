// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/observed.hpp"

#include <mutex>
#include <string>
#include <utility>

#include "deformation/checks.hpp"
#include "deformation/observed/jacobian.hpp"
#include "deformation/observed/jacobian_metric.hpp"
#include "deformation/observed/stored_evaluation.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

std::shared_ptr<const JacobianProducts> checked_products(Jacobian jacobian) {
  jacobian.weights.makeCompressed();
  check_jacobian(jacobian);
  return std::make_shared<JacobianProducts>(std::move(jacobian));
}

void check_ascending(const std::vector<Index>& rotation_rows, Index controls) {
  Index least = 0;
  for (const Index row : rotation_rows) {
    if (row < least || row >= controls)
      throw InputError("rotation_rows: " + std::to_string(row) + " is not in ascending order, or not one of " +
                       std::to_string(controls) + " controls");
    least = row + 1;
  }
}

class Observed final : public ObservedDeformation {
 public:
  Observed(Evaluation evaluate, Jacobian jacobian, std::vector<Index> rotation_rows)
      : products_(checked_products(std::move(jacobian))),
        control_count_(products_->control_count()),
        vertex_count_(products_->vertex_count()),
        evaluation_(std::move(evaluate), vertex_count_),
        rotation_rows_(std::move(rotation_rows)) {
    check_ascending(rotation_rows_, control_count_);
  }

  Index control_count() const override { return control_count_; }
  Index vertex_count() const override { return vertex_count_; }
  std::vector<Index> rotation_rows() const override { return rotation_rows_; }

  Positions surface(const Controls& p, const Execution& execution) const override {
    check_control_rows(p, control_count_);
    return evaluation_.surface(p, execution);
  }

  SparseField pull_back(const ControlsView&, const SparseField& g) const override { return products()->pull_back(g); }
  Positions push_forward(const Controls&, const Controls& d) const override { return products()->push_forward(d); }
  std::vector<Index> support(Index control) const override { return products()->support(control); }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    return make_jacobian_metric(*products(), options, nullptr);
  }
  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    return make_jacobian_metric(*products(), options, &surface_gram);
  }

  std::shared_ptr<const Jacobian> jacobian() const override {
    const std::shared_ptr<const JacobianProducts> now = products();
    return {now, &now->jacobian()};
  }

  void set_jacobian(Jacobian jacobian) override {
    if (jacobian.weights.rows() != vertex_count_ || jacobian.weights.cols() != control_count_)
      throw InputError("jacobian: it is for " + std::to_string(jacobian.weights.rows()) + " vertices and " +
                       std::to_string(jacobian.weights.cols()) + " controls, the deformation has " +
                       std::to_string(vertex_count_) + " and " + std::to_string(control_count_));
    std::shared_ptr<const JacobianProducts> next = checked_products(std::move(jacobian));
    const std::lock_guard lock(mutex_);
    products_ = std::move(next);
    ++revision_;
  }

  std::uint64_t revision() const override {
    const std::lock_guard lock(mutex_);
    return revision_;
  }

 private:
  std::shared_ptr<const JacobianProducts> products() const {
    const std::lock_guard lock(mutex_);
    return products_;
  }

  std::shared_ptr<const JacobianProducts> products_;
  Index control_count_, vertex_count_;
  StoredEvaluation evaluation_;
  std::vector<Index> rotation_rows_;
  std::uint64_t revision_ = 0;
  mutable std::mutex mutex_;  ///< of J
};

}  // namespace

std::shared_ptr<ObservedDeformation> make_observed(Evaluation evaluate, Jacobian jacobian,
                                                   std::vector<Index> rotation_rows) {
  return std::make_shared<Observed>(std::move(evaluate), std::move(jacobian), std::move(rotation_rows));
}

}  // namespace stiv
