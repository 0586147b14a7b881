// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/beside_obstacles.hpp"

#include <utility>

#include "position_rows.hpp"

namespace stiv {

namespace {

class BesideObstacles final : public Deformation {
 public:
  BesideObstacles(std::shared_ptr<const Deformation> deformation, Positions obstacles)
      : deformation_(std::move(deformation)),
        obstacles_(std::move(obstacles)),
        moving_count_(deformation_->vertex_count()) {}

  Index control_count() const override { return deformation_->control_count(); }
  Index vertex_count() const override { return moving_count_ + static_cast<Index>(obstacles_.rows()); }

  Positions surface(const Controls& p, const Execution& execution) const override {
    Positions q(vertex_count(), 3);
    q.topRows(moving_count_) = deformation_->surface(p, execution);
    q.bottomRows(obstacles_.rows()) = obstacles_;
    return q;
  }

  Positions surface_rows(const Controls& p, std::span<const Index> vertices,
                         const Execution& execution) const override {
    Positions q(static_cast<Index>(vertices.size()), 3);
    std::vector<Index> moving, places;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      if (is_moving(vertices[k])) {
        moving.push_back(vertices[k]);
        places.push_back(static_cast<Index>(k));
      } else {
        q.row(static_cast<Index>(k)) = obstacles_.row(vertices[k] - moving_count_);
      }
    }
    if (!moving.empty()) put_rows(q, places, deformation_->surface_rows(p, moving, execution));
    return q;
  }

  SparseField pull_back(const ControlsView& p, const SparseField& g) const override {
    return deformation_->pull_back(p, moving_rows(g));
  }

  std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                         const Execution& execution) const override {
    std::vector<SparseField> moving;
    moving.reserve(g.size());
    for (const SparseField& field : g) moving.push_back(moving_rows(field));
    return deformation_->pull_back_all(p, moving, execution);
  }

  Positions push_forward(const Controls& p, const Controls& d) const override {
    Positions velocity = Positions::Zero(vertex_count(), 3);
    velocity.topRows(moving_count_) = deformation_->push_forward(p, d);
    return velocity;
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override { return deformation_->metric(options); }
  std::uint64_t revision() const override { return deformation_->revision(); }
  std::vector<Index> support(Index control) const override { return deformation_->support(control); }
  std::vector<Index> rotation_rows() const override { return deformation_->rotation_rows(); }
  ScalarRows scalar_rows() const override { return deformation_->scalar_rows(); }

 private:
  bool is_moving(Index vertex) const { return vertex < moving_count_; }

  SparseField moving_rows(const SparseField& g) const {
    SparseField moving;
    for (std::size_t k = 0; k < g.index.size(); ++k) {
      if (!is_moving(g.index[k])) break;  // ascending
      moving.index.push_back(g.index[k]);
      moving.value.push_back(g.value[k]);
    }
    return moving;
  }

  std::shared_ptr<const Deformation> deformation_;
  Positions obstacles_;
  Index moving_count_;
};

}  // namespace

std::shared_ptr<const Deformation> make_beside_obstacles(std::shared_ptr<const Deformation> deformation,
                                                         Positions obstacles) {
  return std::make_shared<BesideObstacles>(std::move(deformation), std::move(obstacles));
}

}  // namespace stiv
