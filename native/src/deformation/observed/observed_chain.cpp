// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <mutex>
#include <utility>

#include "deformation/chain.hpp"
#include "deformation/observed/jacobian.hpp"
#include "deformation/observed/jacobian_metric.hpp"
#include "stiv/deformation/combination.hpp"

namespace stiv {

namespace {

/// The Jacobian of a deformation that has a sparse one.
std::shared_ptr<const Jacobian> jacobian_of(const Deformation& deformation) {
  if (const auto* linear = dynamic_cast<const LinearDeformation*>(&deformation))
    return std::make_shared<Jacobian>(Jacobian{linear->weights(), {}});
  return dynamic_cast<const SparseJacobianDeformation&>(deformation).jacobian();
}

/// A function of the caller after a deformation with a sparse Jacobian.
class SparseChain final : public Chained<SparseJacobianDeformation> {
 public:
  using Chained::Chained;

  std::shared_ptr<const Jacobian> jacobian() const override {
    const std::shared_ptr<const JacobianProducts> now = products();
    return {now, &now->jacobian()};
  }
  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    return make_jacobian_metric(*products(), options, nullptr);
  }
  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    return make_jacobian_metric(*products(), options, &surface_gram);
  }
  std::vector<Index> support(Index control) const override { return products()->support(control); }

 private:
  std::shared_ptr<const JacobianProducts> products() const {
    const std::lock_guard lock(mutex_);
    if (!products_ || at_revision_ != revision()) {
      at_revision_ = revision();
      products_ = std::make_shared<JacobianProducts>(product(*jacobian_of(outer()), *jacobian_of(inner())));
    }
    return products_;
  }

  mutable std::mutex mutex_;
  mutable std::shared_ptr<const JacobianProducts> products_;
  mutable std::uint64_t at_revision_ = 0;
};

/// A function of the caller after a deformation by handles. The metric takes the mean of x, y and z.
class HandleChain final : public Chained<ComposableDeformation> {
 public:
  HandleChain(std::shared_ptr<const SparseJacobianDeformation> outer,
              std::shared_ptr<const ComposableDeformation> inner)
      : Chained(outer, inner), observed_(std::move(outer)), handles_(std::move(inner)) {}

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override { return metric_of(options, nullptr); }
  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    return metric_of(options, &surface_gram);
  }

 private:
  std::unique_ptr<Metric> metric_of(const MetricOptions& options, const WeightMatrix* surface_gram) const {
    const SymmetricMatrix lower = JacobianProducts(*observed_->jacobian()).mean_gram(surface_gram);
    const SymmetricMatrix whole = lower.selfadjointView<Eigen::Lower>();
    return handles_->metric(options, WeightMatrix(whole));
  }

  std::shared_ptr<const SparseJacobianDeformation> observed_;
  std::shared_ptr<const ComposableDeformation> handles_;
};

}  // namespace

std::shared_ptr<const SparseJacobianDeformation> make_composition(
    std::shared_ptr<const SparseJacobianDeformation> outer, std::shared_ptr<const LinearDeformation> inner) {
  check_chain(*outer, *inner);
  return std::make_shared<SparseChain>(std::move(outer), std::move(inner));
}

std::shared_ptr<const ComposableDeformation> make_composition(std::shared_ptr<const SparseJacobianDeformation> outer,
                                                              std::shared_ptr<const ComposableDeformation> inner) {
  check_chain(*outer, *inner);
  if (dynamic_cast<const SparseJacobianDeformation*>(inner.get()) != nullptr)
    return std::make_shared<SparseChain>(std::move(outer), std::move(inner));
  return std::make_shared<HandleChain>(std::move(outer), std::move(inner));
}

}  // namespace stiv
