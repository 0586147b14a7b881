// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/placed_body.hpp"

namespace stiv {

PlacedBody::PlacedBody(const BodyMesh& mesh, const Positions& q) : mesh_(mesh) {
  for (const Index vertex : mesh.vertices) {
    points_.push_back(q.row(vertex));
    box_.extend(points_.back());
  }
}

Triangle PlacedBody::triangle(Index triangle) const {
  const auto& [a, b, c] = corners(triangle);
  return {point(a), point(b), point(c)};
}

Vector3 PlacedBody::area_vector(Index triangle) const {
  const auto& [a, b, c] = corners(triangle);
  return (point(b) - point(a)).cross(point(c) - point(a));
}

double PlacedBody::signed_volume() const {
  double sum = 0;
  for (Index k = 0; k < triangle_count(); ++k) sum += area_vector(k).dot(point(corners(k)[0]) - point(0));
  return sum / 6;
}

}  // namespace stiv
