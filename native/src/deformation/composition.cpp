// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/combination.hpp"

#include <string>
#include <utility>

#include "deformation/chain.hpp"
#include "deformation/linear/weight_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

void check_chain(const Deformation& outer, const Deformation& inner) {
  if (outer.control_count() != inner.vertex_count())
    throw InputError("composition: the outer deformation has " + std::to_string(outer.control_count()) +
                     " controls, the inner one moves " + std::to_string(inner.vertex_count()) +
                     " vertices; both numbers must be equal");
}

namespace {

WeightMatrix gram_of(const WeightMatrix& weights) { return WeightMatrix(weights.transpose()) * weights; }

/// A linear deformation of a surface that another deformation moves.
class LinearChain final : public Chained<ComposableDeformation> {
 public:
  /// weights: those of the outer deformation.
  LinearChain(const WeightMatrix& weights, std::shared_ptr<const LinearDeformation> outer,
              std::shared_ptr<const ComposableDeformation> inner)
      : Chained(std::move(outer), inner), weights_(weights), moved_(std::move(inner)), gram_(gram_of(weights)) {}

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override { return moved_->metric(options, gram_); }

  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    return moved_->metric(options, WeightMatrix(WeightMatrix(weights_.transpose()) * surface_gram * weights_));
  }

 private:
  const WeightMatrix& weights_;
  std::shared_ptr<const ComposableDeformation> moved_;
  WeightMatrix gram_;  ///< of the weights: a renewed J needs it again
};

}  // namespace

std::shared_ptr<const LinearDeformation> make_composition(const LinearDeformation& outer,
                                                          const LinearDeformation& inner) {
  check_chain(outer, inner);
  const bool shifted = inner.offset().rows() > 0 || outer.offset().rows() > 0;
  const Controls origin = Controls::Zero(inner.control_count(), 3);
  return make_linear(weight_product(outer.weights(), inner.weights()),
                     shifted ? outer.surface(inner.surface(origin)) : Positions());
}

std::shared_ptr<const ComposableDeformation> make_composition(std::shared_ptr<const LinearDeformation> outer,
                                                              std::shared_ptr<const ComposableDeformation> inner) {
  check_chain(*outer, *inner);
  const WeightMatrix& weights = outer->weights();
  return std::make_shared<LinearChain>(weights, std::move(outer), std::move(inner));
}

}  // namespace stiv
