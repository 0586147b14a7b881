// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "acceptance/intersection/exact_intersection.hpp"
#include "acceptance/intersection/separating_plane.hpp"
#include "stiv/acceptance/intersections.hpp"

namespace stiv {

namespace {

/// Up to three distinct vertex indices.
struct Corners {
  std::array<Index, 3> index{};
  std::size_t count = 0;

  bool has(Index vertex) const {
    return std::find(index.begin(), index.begin() + count, vertex) != index.begin() + count;
  }
  void add(Index vertex) {
    if (!has(vertex)) index[count++] = vertex;
  }
};

/// Corners that two triangles share, and corners of only one of them, each once.
struct Sharing {
  Corners both, first_only, second_only;

  Sharing(const std::array<Index, 3>& first, const std::array<Index, 3>& second) {
    for (const Index vertex : first)
      (std::find(second.begin(), second.end(), vertex) != second.end() ? both : first_only).add(vertex);
    for (const Index vertex : second)
      if (!both.has(vertex)) second_only.add(vertex);
  }
};

class Points {
 public:
  explicit Points(const PositionsView& q) : q_(q) {}
  Vector3 operator()(Index vertex) const { return q_.row(vertex); }
  Triangle triangle(const std::array<Index, 3>& corners) const {
    return {(*this)(corners[0]), (*this)(corners[1]), (*this)(corners[2])};
  }
  /// The segment of one or two corners.
  Segment segment(const Corners& corners) const {
    return {(*this)(corners.index[0]), (*this)(corners.index[corners.count - 1])};
  }

 private:
  PositionsView q_;
};

bool disjoint_triangles(const Triangle& a, const Triangle& b) {
  return !separated_by_plane(a, b) && triangles_intersect(a, b);
}

bool vertex_neighbours(const Vector3& corner, const Segment& a, const Segment& b) {
  return !separated_at_corner(corner, a, b) && vertex_neighbours_intersect(corner, a, b);
}

bool edge_neighbours(const Segment& edge, const Vector3& a, const Vector3& b) {
  return !separated_at_edge(edge, a, b) && edge_neighbours_intersect(edge, a, b);
}

}  // namespace

bool triangles_intersect(const std::array<Index, 3>& first, const std::array<Index, 3>& second,
                         const PositionsView& q) {
  const Sharing sharing(first, second);
  const Points at(q);
  const Corners &a = sharing.first_only, &b = sharing.second_only;
  if (sharing.both.count == 3) return true;
  if (sharing.both.count == 0) return disjoint_triangles(at.triangle(first), at.triangle(second));
  if (a.count == 0 || b.count == 0) return false;  // one is the shared vertex or edge itself
  if (sharing.both.count == 1) return vertex_neighbours(at(sharing.both.index[0]), at.segment(a), at.segment(b));
  return edge_neighbours(at.segment(sharing.both), at(a.index[0]), at(b.index[0]));
}

}  // namespace stiv
