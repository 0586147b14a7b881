// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/mean_windings.hpp"

#include "penetration/winding_numbers.hpp"

namespace stiv {

namespace {

/// Twice the area between the first corner and the cut, in weights of the other two: where the triangle has 1.
double swept(const std::array<Eigen::Vector2d, 2>& ends) {
  return ends[0].x() * ends[1].y() - ends[0].y() * ends[1].x();
}

}  // namespace

// By the divergence theorem in the plane of the triangle, seen from its first corner: the border has a part in the
// integral along the opposite side alone, and each cut, beyond which w is larger by 1, takes away what it sweeps.
std::vector<double> mean_windings(const Crossings& crossings, std::size_t side) {
  const std::vector<int> numbers = winding_numbers(crossings, side);
  const PlacedBody& body = crossings.body(side);
  std::vector<double> means;
  for (Index k = 0; k < body.triangle_count(); ++k) {
    const auto& corners = body.corners(k);
    means.push_back(crossings.mean_along(side, corners[1], corners[2], numbers[at(corners[1])]));
  }
  for (const Cut& cut : crossings.cuts())
    means[at(cut.triangles[side])] += side == 0 ? swept(cut.ends[0]) : -swept(cut.ends[1]);
  return means;
}

}  // namespace stiv
