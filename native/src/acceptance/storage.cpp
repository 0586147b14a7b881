// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/acceptance/storage.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <sstream>

#include "stiv/error.hpp"

namespace stiv {

namespace {

using Point = Eigen::RowVector3d;

[[noreturn]] void refuse(const StorageFrame& frame, const char* reason) {
  std::ostringstream message;
  message << "storage frame of controls " << frame.first << " to " << frame.first + frame.count - 1 << ": " << reason;
  throw InputError(message.str());
}

/// One trip of a point into single precision in a frame of its own and back.
class RoundTrip {
 public:
  explicit RoundTrip(const StorageFrame& frame)
      : linear_(frame.frame.topLeftCorner<3, 3>()), offset_(frame.frame.topRightCorner<3, 1>()) {
    if (!frame.frame.allFinite()) refuse(frame, "an entry of the matrix is not finite");
    if (frame.frame.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) refuse(frame, "the matrix is not affine");
    const Eigen::FullPivLU<Eigen::Matrix3d> factors(linear_);
    if (!factors.isInvertible()) refuse(frame, "the matrix is singular; give the object a scale other than zero");
    inverse_ = factors.inverse();
  }

  Point operator()(const Point& world) const {
    const Eigen::Vector3f local = (inverse_ * (world.transpose() - offset_)).cast<float>();
    return (linear_ * local.cast<double>() + offset_).transpose();
  }

 private:
  Eigen::Matrix3d linear_, inverse_;
  Vector3 offset_;
};

bool smaller(const Point& a, const Point& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// A round trip in doubles need not return what the one before returned: a local coordinate far smaller than its
/// neighbours loses digits in the world. Trips are repeated until a point recurs, nearly always at once; of a cycle
/// its smallest point stands for all, so that the result does not depend on where the cycle was entered.
Point settled(const Point& world, const RoundTrip& trip) {
  std::vector<Point> seen = {trip(world)};
  while (seen.back().allFinite()) {
    const Point next = trip(seen.back());
    const auto recurring = std::find(seen.begin(), seen.end(), next);
    if (recurring != seen.end()) return *std::min_element(recurring, seen.end(), smaller);
    seen.push_back(next);
  }
  return seen.back();
}

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
    const RoundTrip trip(frame);
    for (Index row = frame.first; row < frame.first + frame.count; ++row) {
      stored.row(row) = settled(p.row(row), trip);
      if (stored.row(row).allFinite()) continue;
      refuse(frame, ("control " + std::to_string(row) + " is too large for single precision").c_str());
    }
  }
  return stored;
}

}  // namespace stiv
