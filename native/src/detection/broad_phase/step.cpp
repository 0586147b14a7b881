// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/step.hpp"

namespace stiv {

namespace {

constexpr double much_smaller = 1.0 / 4;

struct Sums {
  Vector3 displacement = Vector3::Zero();
  double square = 0;
};

}  // namespace

Vector3 common_motion(const PositionsView& start, const PositionsView& end) {
  constexpr Index enough = 1024;
  const auto all = static_cast<Index>(start.rows());
  const Index stride = all / enough + 1;
  Index count = 0;
  Sums whole;
  for (Index vertex = 0; vertex < all; vertex += stride, ++count) {
    const Vector3 displacement = end.row(vertex) - start.row(vertex);
    whole.displacement += displacement;
    whole.square += displacement.squaredNorm();
  }
  if (count == 0) return Vector3::Zero();
  const Vector3 mean = whole.displacement / count;
  const double left = whole.square - count * mean.squaredNorm();
  return left <= much_smaller * whole.square ? mean : Vector3(Vector3::Zero());
}

}  // namespace stiv
