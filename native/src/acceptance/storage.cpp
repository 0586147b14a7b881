// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/acceptance/storage.hpp"

#include <Eigen/LU>
#include <sstream>
#include <utility>

#include "stiv/error.hpp"

namespace stiv {

namespace {

[[noreturn]] void refuse(const StorageFrame& frame, const char* reason) {
  std::ostringstream message;
  message << "storage frame of controls " << frame.first << " to " << frame.first + frame.count - 1 << ": " << reason;
  throw InputError(message.str());
}

constexpr double unit = 0x1p-53;  // half a unit in the last place of 1

/// Coordinates rounded to single precision. Volatile because GCC 12 at -O2 vectorizes the conversions and leaves one
/// coordinate of three unrounded.
Vector3 in_single_precision(const Vector3& point) {
  Vector3 rounded;
  for (Index axis = 0; axis < 3; ++axis) {
    const volatile float single = static_cast<float>(point[axis]);
    rounded[axis] = static_cast<double>(single);
  }
  return rounded;
}

/// Rounds points to single precision in a frame; idempotent.
class Storing {
 public:
  explicit Storing(const StorageFrame& frame)
      : linear_(frame.frame.topLeftCorner<3, 3>()), offset_(frame.frame.topRightCorner<3, 1>()) {
    if (!frame.frame.allFinite()) refuse(frame, "an entry of the matrix is not finite");
    if (frame.frame.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) refuse(frame, "the matrix is not affine");
    const Eigen::FullPivLU<Eigen::Matrix3d> factors(linear_);
    if (!factors.isInvertible()) refuse(frame, "the matrix is singular; give the object a scale other than zero");
    inverse_ = factors.inverse();
    spread_ = linear_.cwiseAbs() * inverse_.cwiseAbs();
  }

  /// Storing a stored point again changes it by an error of doubles, since a local coordinate far smaller than the
  /// others loses digits in the world. A point within that error counts as stored and is returned unchanged.
  /// (mathematics.md, "Values as stored")
  void store(Vector3& point) const {
    const Vector3 local = in_single_precision(inverse_ * (point - offset_));
    const Vector3 back = linear_ * local + offset_;
    const Vector3 magnitude = linear_.cwiseAbs() * local.cwiseAbs() + offset_.cwiseAbs();
    const Vector3 error = 64 * unit * (spread_ * magnitude);
    const bool is_stored = ((back - point).array().abs() <= error.array()).all();
    if (!is_stored) point = back;
  }

 private:
  Eigen::Matrix3d linear_, inverse_, spread_;
  Vector3 offset_;
};

void check_rows(const StorageFrame& frame, Index controls) {
  if (frame.first >= 0 && frame.count >= 0 && frame.count <= controls - frame.first) return;
  std::ostringstream reason;
  reason << "there are " << controls << " controls";
  refuse(frame, reason.str().c_str());
}

}  // namespace

Controls as_stored(const Controls& p, const std::vector<StorageFrame>& frames) {
  Controls stored = p;
  for (const StorageFrame& frame : frames) {
    check_rows(frame, static_cast<Index>(p.rows()));
    const Storing storing(frame);
    for (Index row = frame.first; row < frame.first + frame.count; ++row) {
      Vector3 point = p.row(row);
      storing.store(point);
      stored.row(row) = point;
      if (stored.row(row).allFinite()) continue;
      refuse(frame, ("control " + std::to_string(row) + " is too large for single precision").c_str());
    }
  }
  return stored;
}

namespace {

class StoredMesh final : public HandleDeformation {
 public:
  StoredMesh(std::shared_ptr<const HandleDeformation> mesh, const Eigen::Matrix4d& frame)
      : mesh_(std::move(mesh)), storage_{{0, mesh_->vertex_count(), frame}} {
    as_stored(Positions::Zero(mesh_->vertex_count(), 3), storage_);  // checks the frame
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
