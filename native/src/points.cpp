// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/points.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "stiv/error.hpp"

namespace stiv {

namespace {

template <class View>
Positions transformed(const AffineMap& map, const View& points) {
  Positions result(points.rows(), 3);
  const auto* from = points.data();
  double* to = result.data();
  for (Index row = 0; row < points.rows(); ++row, from += 3, to += 3) {
    const double x = from[0], y = from[1], z = from[2];
    for (Index k = 0; k < 3; ++k) to[k] = ((map(k, 0) * x + map(k, 2) * z) + map(k, 1) * y) + map(k, 3);
  }
  return result;
}

constexpr Index block_size = 16;  // quads whose arithmetic is done at once
using Lanes = Eigen::Array<float, block_size, 1>;
using Vectors = std::array<Lanes, 3>;

float largest_coordinate(const SinglePositionsView& points) {
  if (points.rows() == 0) return 0;
  return Eigen::Map<const Eigen::ArrayXf>(points.data(), points.size()).abs().maxCoeff<Eigen::PropagateNaN>();
}

void gather(const SinglePositionsView& points, const Index* corners, Index count, Vectors& gathered) {
  for (Index k = 0; k < count; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) gathered[axis][k] = points(corners[k], static_cast<Index>(axis));
}

Vectors difference(const Vectors& a, const Vectors& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vectors cross(const Vectors& a, const Vectors& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Lanes dot(const Vectors& a, const Vectors& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Lanes length(const Vectors& a) { return dot(a, a).sqrt(); }

/// Values that are not numbers are not certainly open.
Eigen::Array<bool, block_size, 1> is_folded(const std::array<Vectors, 4>& corners, float cosine, float narrow) {
  const Vectors diagonal = difference(corners[2], corners[0]);
  const Vectors one = cross(difference(corners[1], corners[0]), diagonal);
  const Vectors two = cross(diagonal, difference(corners[3], corners[0]));
  const Lanes first = length(one), second = length(two), least = narrow * length(diagonal);
  return !(dot(one, two) > cosine * first * second && first > least && second > least);
}

}  // namespace

Positions transform_points(const AffineMap& map, const PositionsView& points) { return transformed(map, points); }

Positions transform_points(const AffineMap& map, const SinglePositionsView& points) { return transformed(map, points); }

double largest_difference(const PositionsView& first, const PositionsView& second) {
  if (first.rows() != second.rows()) throw InputError("the numbers of points differ");
  if (first.rows() == 0) return 0;
  const Eigen::Map<const Eigen::ArrayXd> a(first.data(), first.size()), b(second.data(), second.size());
  return (a - b).abs().maxCoeff<Eigen::PropagateNaN>();
}

std::vector<Index> find_folded(const SinglePositionsView& points, const Eigen::Ref<const QuadCorners>& corners,
                               float cosine, float narrow) {
  if (corners.size() > 0 && (corners.minCoeff() < 0 || corners.maxCoeff() >= points.rows()))
    throw InputError("corners: there is no such point");
  std::vector<Index> folded;
  const float least = narrow * largest_coordinate(points);
  const auto total = static_cast<Index>(corners.cols());
  std::array<Vectors, 4> block;
  for (Vectors& corner : block)
    for (Lanes& axis : corner) axis.setZero();
  for (Index begin = 0; begin < total; begin += block_size) {
    const Index count = std::min(block_size, total - begin);
    for (std::size_t corner = 0; corner < 4; ++corner)
      gather(points, corners.row(static_cast<Index>(corner)).data() + begin, count, block[corner]);
    const auto found = is_folded(block, cosine, least);
    for (Index k = 0; k < count; ++k)
      if (found[k]) folded.push_back(begin + k);
  }
  return folded;
}

}  // namespace stiv
