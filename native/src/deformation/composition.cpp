// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/combination.hpp"

#include <string>
#include <utility>

#include "deformation/linear/weight_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

using Entry = WeightMatrix::InnerIterator;

WeightMatrix product(const WeightMatrix& outer, const WeightMatrix& inner) {
  WeightRows rows(static_cast<Index>(outer.rows()), static_cast<Index>(inner.cols()));
  for (Index row = 0; row < outer.rows(); ++row) {
    for (Entry a(outer, row); a; ++a)
      for (Entry b(inner, a.col()); b; ++b) rows.add(static_cast<Index>(b.col()), a.value() * b.value());
    rows.end_row();
  }
  return rows.matrix();
}

void check_fit(const LinearDeformation& outer, const Deformation& inner) {
  if (outer.control_count() != inner.vertex_count())
    throw InputError("composition: the outer deformation has " + std::to_string(outer.control_count()) +
                     " controls, the inner one moves " + std::to_string(inner.vertex_count()) +
                     " vertices; both numbers must be equal");
}

/// A linear deformation of a mesh moved by handles.
class Chain final : public HandleDeformation {
 public:
  Chain(std::shared_ptr<const LinearDeformation> outer, std::shared_ptr<const HandleDeformation> inner)
      : outer_(std::move(outer)), inner_(std::move(inner)) {}

  Index control_count() const override { return inner_->control_count(); }
  Index vertex_count() const override { return outer_->vertex_count(); }
  Positions surface(const Controls& p, const Execution& execution) const override {
    return outer_->surface(inner_->surface(p, execution), execution);
  }

  SparseField pull_back(const ControlsView& p, const SparseField& g) const override {
    return inner_->pull_back(p, outer_->pull_back(Controls(), g));  // the outer Jacobian is constant
  }

  std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                         const Execution& execution) const override {
    return inner_->pull_back_all(p, outer_->pull_back_all(Controls(), g, execution), execution);
  }

  Positions push_forward(const Controls& p, const Controls& d) const override {
    return outer_->push_forward({}, inner_->push_forward(p, d));
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    const WeightMatrix& weights = outer_->weights();
    return inner_->metric(options, WeightMatrix(WeightMatrix(weights.transpose()) * weights));
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    const WeightMatrix& weights = outer_->weights();
    return inner_->metric(options, WeightMatrix(WeightMatrix(weights.transpose()) * surface_gram * weights));
  }

  std::vector<Index> support(Index control) const override {
    std::vector<unsigned char> moves(static_cast<std::size_t>(vertex_count()), 0);
    for (const Index vertex : inner_->support(control))
      for (const Index moved : outer_->support(vertex)) moves[at(moved)] = 1;
    std::vector<Index> vertices;
    for (Index vertex = 0; vertex < vertex_count(); ++vertex)
      if (moves[at(vertex)] != 0) vertices.push_back(vertex);
    return vertices;
  }

 private:
  std::shared_ptr<const LinearDeformation> outer_;
  std::shared_ptr<const HandleDeformation> inner_;
};

}  // namespace

std::shared_ptr<const LinearDeformation> make_composition(const LinearDeformation& outer,
                                                          const LinearDeformation& inner) {
  check_fit(outer, inner);
  const bool shifted = inner.offset().rows() > 0 || outer.offset().rows() > 0;
  const Controls origin = Controls::Zero(inner.control_count(), 3);
  return make_linear(product(outer.weights(), inner.weights()),
                     shifted ? outer.surface(inner.surface(origin)) : Positions());
}

std::shared_ptr<const HandleDeformation> make_composition(std::shared_ptr<const LinearDeformation> outer,
                                                          std::shared_ptr<const HandleDeformation> inner) {
  check_fit(*outer, *inner);
  return std::make_shared<Chain>(std::move(outer), std::move(inner));
}

}  // namespace stiv
