// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/placement.hpp"

#include <numeric>
#include <utility>

#include "deformation/checks.hpp"
#include "deformation/placement/placement_metric.hpp"
#include "deformation/rotation.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// J'J of the rotation at rotation vector v, damped relative to the inertia about the world axes. The damping does not
/// vanish at full turns, where the left Jacobian is singular.
Eigen::Matrix3d rotation_block(const Eigen::Matrix3d& rest_inertia, const Vector3& v, double smoothness) {
  const Eigen::Matrix3d rotation = rotation_matrix(v);
  const Eigen::Matrix3d inertia = rotation * rest_inertia * rotation.transpose();
  const Eigen::Matrix3d jacobian = left_jacobian(v);
  Eigen::Matrix3d block = jacobian.transpose() * inertia * jacobian;
  block.diagonal() += placement_damping(inertia.diagonal(), smoothness);
  return block;
}

class Rigid final : public Deformation {
 public:
  /// @param offset of the pivot from the mean
  Rigid(Positions from_pivot, const Eigen::RowVector3d& offset) : from_pivot_(std::move(from_pivot)), offset_(offset) {}

  Index control_count() const override { return 2; }
  Index vertex_count() const override { return static_cast<Index>(from_pivot_.rows()); }

  Positions surface(const Controls& p, const Execution&) const override {
    check_control_rows(p, 2);
    return (from_pivot_ * rotation_matrix(p.row(1)).transpose()).rowwise() + (p.row(0) + offset_);
  }

  SparseField pull_back(const ControlsView& p, const SparseField& g) const override {
    if (g.index.empty()) return {};
    const Eigen::Matrix3d rotation = rotation_matrix(p.row(1));
    Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
    for (std::size_t k = 0; k < g.index.size(); ++k) {
      const Vector3 arm = rotation * from_pivot_.row(g.index[k]).transpose();
      force += g.value[k];
      torque += arm.cross(g.value[k]);
    }
    return {{0, 1}, {force, left_jacobian(p.row(1)).transpose() * torque}};
  }

  Positions push_forward(const Controls& p, const Controls& d) const override {
    check_control_rows(d, 2);
    const Vector3 turn = left_jacobian(p.row(1)) * d.row(1).transpose();
    const Eigen::Matrix3d velocity = cross_matrix(turn) * rotation_matrix(p.row(1));
    return (from_pivot_ * velocity.transpose()).rowwise() + d.row(0);
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    const Eigen::Matrix3d scatter = from_pivot_.transpose() * from_pivot_;
    const Eigen::Matrix3d inertia = scatter.trace() * Eigen::Matrix3d::Identity() - scatter;
    const auto block = [inertia, smoothness = options.smoothness](const ControlsView& p) {
      return rotation_block(inertia, p.row(1), smoothness);
    };
    return make_placement_metric(vertex_count(), block, options);
  }

  std::vector<Index> support(Index) const override {
    std::vector<Index> vertices(static_cast<std::size_t>(vertex_count()));
    std::iota(vertices.begin(), vertices.end(), 0);
    return vertices;
  }

  std::vector<Index> rotation_rows() const override { return {1}; }

 private:
  Positions from_pivot_;  ///< r_i = rest_i - pivot, (n, 3)
  Eigen::RowVector3d offset_;
};

}  // namespace

std::shared_ptr<const Deformation> make_rigid(const Positions& rest, const std::optional<Vector3>& pivot) {
  check_finite(rest, "rigid body, vertex");
  const Eigen::RowVector3d mean = rigid_rest_controls(rest).row(0);
  if (!pivot) return std::make_shared<Rigid>(rest.rowwise() - mean, Eigen::RowVector3d::Zero());
  if (!pivot->allFinite()) throw InputError("rigid body: the pivot is not finite");
  return std::make_shared<Rigid>(rest.rowwise() - pivot->transpose(), pivot->transpose() - mean);
}

Controls rigid_rest_controls(const Positions& rest) {
  Controls p = Controls::Zero(2, 3);
  if (rest.rows() > 0) p.row(0) = rest.colwise().mean();
  return p;
}

}  // namespace stiv
