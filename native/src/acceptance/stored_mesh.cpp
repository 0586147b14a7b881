// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/acceptance/stored_mesh.hpp"

#include <utility>

#include "stiv/acceptance/storage.hpp"

namespace stiv {

namespace {

class StoredMesh final : public HandleDeformation {
 public:
  StoredMesh(std::shared_ptr<const HandleDeformation> mesh, const Eigen::Matrix4d& frame)
      : mesh_(std::move(mesh)), storage_{{0, mesh_->vertex_count(), frame}} {
    as_stored(Positions::Zero(mesh_->vertex_count(), 3), storage_);  // refuses a frame that cannot store anything
  }

  Index control_count() const override { return mesh_->control_count(); }
  Index vertex_count() const override { return mesh_->vertex_count(); }
  Positions surface(const Controls& p, const Execution& execution) const override {
    return as_stored(mesh_->surface(p, execution), storage_);
  }
  SparseField pull_back(const ControlsView& p, const SparseField& g) const override { return mesh_->pull_back(p, g); }
  std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                         const Execution& execution) const override {
    return mesh_->pull_back_all(p, g, execution);
  }
  Positions push_forward(const Controls& p, const Controls& d) const override { return mesh_->push_forward(p, d); }
  std::unique_ptr<Metric> metric(const MetricOptions& options) const override { return mesh_->metric(options); }
  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    return mesh_->metric(options, surface_gram);
  }
  std::vector<Index> support(Index control) const override { return mesh_->support(control); }

 private:
  std::shared_ptr<const HandleDeformation> mesh_;
  std::vector<StorageFrame> storage_;
};

}  // namespace

std::shared_ptr<const HandleDeformation> make_stored_mesh(std::shared_ptr<const HandleDeformation> mesh,
                                                          const Eigen::Matrix4d& frame) {
  return std::make_shared<StoredMesh>(std::move(mesh), frame);
}

}  // namespace stiv
