// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/placement.hpp"

#include <Eigen/LU>
#include <numeric>
#include <utility>

#include "deformation/checks.hpp"
#include "deformation/placement/placement_metric.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

class Scaling final : public Deformation {
 public:
  Scaling(Positions along_axes, Eigen::Matrix3d rotation)
      : along_axes_(std::move(along_axes)), rotation_(std::move(rotation)) {}

  Index control_count() const override { return 2; }
  Index vertex_count() const override { return static_cast<Index>(along_axes_.rows()); }

  Positions surface(const Controls& p, const Execution&) const override { return placed(p); }

  SparseField pull_back(const ControlsView&, const SparseField& g) const override {
    if (g.index.empty()) return {};
    Vector3 force = Vector3::Zero(), stretch = Vector3::Zero();
    for (std::size_t k = 0; k < g.index.size(); ++k) {
      force += g.value[k];
      stretch += along_axes_.row(g.index[k]).transpose().cwiseProduct(rotation_.transpose() * g.value[k]);
    }
    return {{0, 1}, {force, stretch}};
  }

  // The map is linear, so without its offset it is its own derivative.
  Positions push_forward(const Controls&, const Controls& d) const override { return placed(d); }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    const Vector3 diagonal = along_axes_.colwise().squaredNorm();
    const Vector3 damped = diagonal + placement_damping(diagonal, options.smoothness);
    const auto block = [damped](const Controls&) -> Eigen::Matrix3d { return damped.asDiagonal(); };
    return make_placement_metric(vertex_count(), block, options);
  }

  std::vector<Index> support(Index) const override {
    std::vector<Index> vertices(static_cast<std::size_t>(vertex_count()));
    std::iota(vertices.begin(), vertices.end(), 0);
    return vertices;
  }

 private:
  Positions placed(const Controls& p) const {
    check_control_rows(p, 2);
    const Eigen::Matrix3d stretch = p.row(1).asDiagonal() * rotation_.transpose();
    return (along_axes_ * stretch).rowwise() + p.row(0);
  }

  Positions along_axes_;  ///< R' r_i, (n, 3)
  Eigen::Matrix3d rotation_;
};

void check_rotation(const Eigen::Matrix3d& rotation) {
  const double error = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  // Blender stores matrices in single precision.
  if (!(error < 1e-5) || !(rotation.determinant() > 0))
    throw InputError(
        "scaling: the matrix of the axes is not a rotation; give unit columns at right angles, without scale");
}

}  // namespace

std::shared_ptr<const Deformation> make_scaling(const Positions& rest, const Eigen::Matrix3d& rotation) {
  check_finite(rest, "scaled body, vertex");
  check_rotation(rotation);
  return std::make_shared<Scaling>((rest.rowwise() - scaling_rest_controls(rest).row(0)) * rotation, rotation);
}

Controls scaling_rest_controls(const Positions& rest) {
  Controls p = Controls::Ones(2, 3);
  p.row(0).setZero();
  if (rest.rows() > 0) p.row(0) = rest.colwise().mean();
  return p;
}

}  // namespace stiv
