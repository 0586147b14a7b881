// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// @throws InputError unless `outer` has as many controls as `inner` has vertices
void check_chain(const Deformation& outer, const Deformation& inner);

/// q = outer(inner(p)), where J of `outer` does not depend on its controls. Without a metric.
template <class Base>
class Chained : public Base {
 public:
  Chained(std::shared_ptr<const Deformation> outer, std::shared_ptr<const Deformation> inner)
      : outer_(std::move(outer)), inner_(std::move(inner)) {}

  Index control_count() const override { return inner_->control_count(); }
  Index vertex_count() const override { return outer_->vertex_count(); }
  std::vector<Index> rotation_rows() const override { return inner_->rotation_rows(); }
  ScalarRows scalar_rows() const override { return inner_->scalar_rows(); }
  std::uint64_t revision() const override { return outer_->revision() + inner_->revision(); }

  Positions surface(const Controls& p, const Execution& execution) const override {
    return outer_->surface(inner_->surface(p, execution), execution);
  }

  SparseField pull_back(const ControlsView& p, const SparseField& g) const override {
    return inner_->pull_back(p, outer_->pull_back(Controls(), g));
  }

  std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                         const Execution& execution) const override {
    return inner_->pull_back_all(p, outer_->pull_back_all(Controls(), g, execution), execution);
  }

  Positions push_forward(const Controls& p, const Controls& d) const override {
    return outer_->push_forward({}, inner_->push_forward(p, d));
  }

  bool has_cheaper_columns() const override { return inner_->has_cheaper_columns(); }

  void visit_columns(const Controls& p, const Execution& execution,
                     const std::function<void(Index, const Deformation::ControlColumns&)>& visit) const override {
    inner_->visit_columns(p, execution, [&](Index control, const Deformation::ControlColumns& columns) {
      Deformation::ControlColumns moved;
      for (std::size_t axis = 0; axis < moved.size(); ++axis) moved[axis] = outer_->push_forward({}, columns[axis]);
      visit(control, moved);
    });
  }

  std::vector<Index> support(Index control) const override {
    std::set<Index> vertices;
    for (const Index middle : inner_->support(control))
      for (const Index vertex : outer_->support(middle)) vertices.insert(vertex);
    return {vertices.begin(), vertices.end()};
  }

 protected:
  const Deformation& outer() const { return *outer_; }
  const Deformation& inner() const { return *inner_; }

 private:
  std::shared_ptr<const Deformation> outer_, inner_;
};

}  // namespace stiv
