// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "deformation/checks.hpp"
#include "deformation/lattice/lattice_sums.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// Equals the linear deformation `linear`, but products use the weights along each axis.
class Lattice final : public LinearDeformation {
 public:
  Lattice(std::shared_ptr<const LinearDeformation> linear, LatticeSums sums)
      : linear_(std::move(linear)), sums_(std::move(sums)) {}

  Index control_count() const override { return linear_->control_count(); }
  Index vertex_count() const override { return linear_->vertex_count(); }

  Positions surface(const Controls& p, const Execution& execution) const override {
    Positions q(vertex_count(), 3);
    put_surface(p, {}, q, execution);
    return q;
  }

  void put_surface(const Controls& p, std::span<const Index> rows, Positions& q,
                   const Execution& execution) const override {
    check_control_rows(p, control_count());
    sums_.put(p, {.offset = &offset(), .places = rows}, q, execution);
  }

  Positions surface_rows(const Controls& p, std::span<const Index> vertices,
                         const Execution& execution) const override {
    check_control_rows(p, control_count());
    Positions q(static_cast<Index>(vertices.size()), 3);
    if (!vertices.empty()) sums_.put(p, {.offset = &offset(), .vertices = vertices}, q, execution);
    return q;
  }

  SparseField pull_back(const ControlsView& p, const SparseField& g) const override { return linear_->pull_back(p, g); }

  Positions push_forward(const Controls&, const Controls& d) const override {
    check_control_rows(d, control_count());
    return sums_.sum(d, Execution(1));
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override { return linear_->metric(options); }
  std::vector<Index> support(Index control) const override { return linear_->support(control); }
  const WeightMatrix& weights() const override { return linear_->weights(); }
  const Positions& offset() const override { return linear_->offset(); }

 private:
  std::shared_ptr<const LinearDeformation> linear_;
  LatticeSums sums_;
};

}  // namespace

std::shared_ptr<const LinearDeformation> make_lattice(const LatticeDefinition& lattice,
                                                      const LatticePlacement& placed) {
  WeightMatrix weights = lattice_weights(lattice, placed.rest_vertices, placed.influence);
  if (placed.vertices.rows() != weights.rows())
    throw InputError("lattice: " + std::to_string(placed.vertices.rows()) + " undeformed positions for " +
                     std::to_string(weights.rows()) + " vertices; give one for each");
  check_control_rows(placed.points, static_cast<Index>(weights.cols()));
  LatticeSums sums(lattice_axes(lattice), placed.rest_vertices,
                   lattice_factors(lattice, placed.rest_vertices, placed.influence));
  const Positions offset = placed.vertices - sums.sum(placed.points, Execution(1));
  return std::make_shared<Lattice>(make_linear(weights, offset), std::move(sums));
}

}  // namespace stiv
