// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/acceptance/storage.hpp"

#include <Eigen/LU>
#include <sstream>

#include "stiv/error.hpp"

namespace stiv {

namespace {

[[noreturn]] void refuse(const StorageFrame& frame, const char* reason) {
  std::ostringstream message;
  message << "storage frame of controls " << frame.first << " to " << frame.first + frame.count - 1 << ": " << reason;
  throw InputError(message.str());
}

constexpr double unit = 0x1p-53;  // half a unit in the last place of 1

/// Coordinates rounded to single precision. Volatile: GCC 12 vectorises the conversion there and back at -O2 such that
/// one coordinate of three keeps its double.
Vector3 in_single_precision(const Vector3& point) {
  Vector3 rounded;
  for (Index axis = 0; axis < 3; ++axis) {
    const volatile float single = static_cast<float>(point[axis]);
    rounded[axis] = static_cast<double>(single);
  }
  return rounded;
}

/// Into single precision in a frame and back, without a change to what has been there before.
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

  /// A stored point that is stored again comes back with an error of doubles: a local coordinate far smaller than its
  /// neighbours loses digits in the world. Up to that error a point counts as stored, and stays as it is: this, not the
  /// trip, is idempotent. [docs/mathematics.md, "Values as stored"]
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

}  // namespace stiv
