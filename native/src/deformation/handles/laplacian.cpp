// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/handles.hpp"

#include "deformation/checks.hpp"
#include "deformation/handles/handle_map.hpp"
#include "deformation/handles/mesh_laplacian.hpp"

namespace stiv {

namespace {

/// q = rest + M (p - p at rest): the normal equations L'L (q - rest) + pull (q - p) = 0 of the free vertices.
class Laplacian final : public HandleDeformation {
 public:
  Laplacian(const HandleDefinition& definition, const Surface& mesh)
      : rest_(definition.rest),
        rest_controls_(rest_(definition.handles, Eigen::all)),
        handles_(definition.handles),
        hard_(definition.pull.size() == 0),
        map_(definition, mesh, squared_laplacian(edge_weights(mesh, rest_, definition.edge_weights))) {}

  Index control_count() const override { return map_.control_count(); }
  Index vertex_count() const override { return map_.vertex_count(); }

  Positions surface(const Controls& p, const Execution&) const override {
    check_control_rows(p, control_count());
    Positions q = rest_ + map_.follow(p - rest_controls_);
    if (hard_)
      for (Index k = 0; k < control_count(); ++k) q.row(handles_[at(k)]) = p.row(k);
    return q;
  }

  SparseField pull_back(const ControlsView&, const SparseField& g) const override { return map_.pull_back(g); }

  std::vector<SparseField> pull_back_all(const ControlsView&, const std::vector<SparseField>& g,
                                         const Execution& execution) const override {
    return map_.pull_back_all(g, execution);
  }

  Positions push_forward(const Controls&, const Controls& d) const override {
    check_control_rows(d, control_count());
    return map_.follow(d);
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override { return map_.metric(options, nullptr); }

  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    return map_.metric(options, &surface_gram);
  }

  std::vector<Index> support(Index control) const override { return map_.support(control); }

 private:
  Positions rest_;
  Controls rest_controls_;
  std::vector<Index> handles_;
  bool hard_;
  HandleMap map_;
};

}  // namespace

std::shared_ptr<const HandleDeformation> make_laplacian(const HandleDefinition& definition) {
  return std::make_shared<Laplacian>(definition, checked_mesh(definition));
}

}  // namespace stiv
