// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "stiv/acceptance/intersections.hpp"

using namespace stiv;

namespace {

using Corners = std::array<Index, 3>;

Positions points(std::initializer_list<Vector3> rows) {
  Positions q(static_cast<Index>(rows.size()), 3);
  Index row = 0;
  for (const Vector3& point : rows) q.row(row++) = point;
  return q;
}

/// The answer must not depend on the order of triangles and corners, on scale, or on a shift by integers.
bool intersect(Corners first, Corners second, const Positions& q) {
  const bool answer = triangles_intersect(first, second, q);
  for (int turn = 0; turn < 3; ++turn) {
    std::rotate(first.begin(), first.begin() + 1, first.end());
    CHECK(triangles_intersect(first, second, q) == answer);
    CHECK(triangles_intersect(second, first, q) == answer);
    CHECK(triangles_intersect({first[1], first[0], first[2]}, second, q) == answer);
  }
  for (const double scale : {0x1p-23, 0x1p23}) CHECK(triangles_intersect(first, second, scale * q) == answer);
  Positions shifted = q;
  shifted.rowwise() += Eigen::RowVector3d(1 << 20, -(1 << 21), 1 << 19);
  CHECK(triangles_intersect(first, second, shifted) == answer);
  return answer;
}

const Corners first{0, 1, 2}, second{3, 4, 5};

}  // namespace

TEST_CASE("triangles_intersect: triangles without a common vertex") {
  const Vector3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  CHECK(intersect(first, second, points({a, b, c, {1, 1, -1}, {1, 1, 1}, {9, 9, 1}})));           // pierced
  CHECK(intersect(first, second, points({a, b, c, {1, 1, 0}, {1, 1, 1}, {2, 1, 1}})));            // vertex on face
  CHECK(intersect(first, second, points({a, b, c, {2, 0, -1}, {2, 0, 1}, {2, -3, 0}})));          // edge on edge
  CHECK(intersect(first, second, points({a, b, c, a, {-1, -1, 1}, {-1, -1, -1}})));               // vertex on vertex
  CHECK(intersect(first, second, points({a, b, c, {1, 1, 0}, {2, 1, 0}, {1, 2, 0}})));            // coplanar, inside
  CHECK(intersect(first, second, points({a, b, c, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}})));            // along an edge
  CHECK(intersect(first, second, points({a, b, c, a, b, c})));                                    // duplicate
  CHECK_FALSE(intersect(first, second, points({a, b, c, {3, 3, 0}, {5, 3, 0}, {3, 5, 0}})));      // coplanar, apart
  CHECK_FALSE(intersect(first, second, points({a, b, c, {0, 0, 1}, {4, 0, 1}, {0, 4, 1}})));      // parallel
  CHECK_FALSE(intersect(first, second, points({a, b, c, {3, 3, -1}, {3, 3, 1}, {9, 9, 0}})));     // passes beside
  CHECK_FALSE(intersect(first, second, points({a, b, c, {1, 1, 0.125}, {1, 1, 1}, {2, 1, 1}})));  // just above
}

TEST_CASE("triangles_intersect: a shared vertex") {
  const Corners neighbour{0, 3, 4};
  const Vector3 v(0, 0, 0), a(4, 0, 0), b(0, 4, 0);
  CHECK_FALSE(intersect(first, neighbour, points({v, a, b, {-1, 0, 0}, {0, -1, 0}})));  // coplanar fan
  CHECK_FALSE(intersect(first, neighbour, points({v, a, b, {1, 1, 1}, {1, 1, 2}})));    // above
  CHECK(intersect(first, neighbour, points({v, a, b, {1, 1, 1}, {1, 1, -1}})));         // pierces
  CHECK(intersect(first, neighbour, points({v, a, b, {1, 1, 0}, {-1, 1, 3}})));         // vertex on face
  CHECK(intersect(first, neighbour, points({v, a, b, {9, 9, 0}, {-1, 1, 3}})));         // edge over face
  CHECK(intersect(first, neighbour, points({v, a, b, {2, 0, 0}, {0, -1, 0}})));         // sides overlap
  CHECK(intersect(first, neighbour, points({v, a, b, {1, 2, 0}, {2, 1, 0}})));          // coplanar, inside
  CHECK_FALSE(intersect(first, neighbour, points({v, a, b, {-1, 0, 0}, {0, 1, 5}})));   // opposite sides
}

TEST_CASE("triangles_intersect: a shared edge, folded or not") {
  const Corners neighbour{1, 0, 3};
  const Vector3 e0(0, 0, 0), e1(4, 0, 0), a(1, 3, 0);
  CHECK_FALSE(intersect(first, neighbour, points({e0, e1, a, {2, -2, 0}})));       // flat
  CHECK_FALSE(intersect(first, neighbour, points({e0, e1, a, {2, 2, 0x1p-30}})));  // nearly folded
  CHECK(intersect(first, neighbour, points({e0, e1, a, {2, 2, 0}})));              // folded flat
  CHECK(intersect(first, neighbour, points({e0, e1, a, {9, 1, 0}})));              // folded, leaning over
  CHECK(intersect(first, neighbour, points({e0, e1, a, a})));                      // folded, other index
  CHECK_FALSE(intersect(first, neighbour, points({e0, e1, a, {2, 0, 0}})));        // a sliver inside the edge
  CHECK_FALSE(intersect(first, neighbour, points({e0, e1, a, {9, 0, 0}})));        // a sliver beyond it
}

TEST_CASE("triangles_intersect: the same three vertices always do") {
  CHECK(intersect(first, {2, 1, 0}, points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})));
}

TEST_CASE("triangles_intersect: triangles without area") {
  const Vector3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0), on(1, 1, 0), above(1, 1, 1), below(1, 1, -1);
  CHECK(intersect(first, second, points({a, b, c, below, on, above})));           // segment through
  CHECK(intersect(first, second, points({a, b, c, on, on, on})));                 // point on face
  CHECK_FALSE(intersect(first, second, points({a, b, c, above, above, above})));  // point beside
  CHECK(intersect(first, {3, 3, 4}, points({a, b, c, below, above})));            // repeated corner
  CHECK_FALSE(intersect(first, {0, 0, 3}, points({a, b, c, above})));             // edge from a shared vertex
  CHECK(intersect(first, {0, 0, 3}, points({a, b, c, on})));                      // edge in the face
  CHECK_FALSE(intersect(first, {0, 0, 1}, points({a, b, c})));                    // the edge itself
  CHECK_FALSE(intersect(first, {0, 0, 0}, points({a, b, c})));                    // the vertex itself
  CHECK(intersect({0, 1, 2}, {0, 3, 4}, points({a, {-2, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 1}})));
  CHECK_FALSE(intersect({0, 1, 2}, {0, 3, 4}, points({a, {-2, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 1, 1}})));
  CHECK(intersect({0, 1, 2}, {0, 1, 3}, points({a, b, {5, 0, 0}, {6, 0, 0}})));         // slivers beyond one end
  CHECK_FALSE(intersect({0, 1, 2}, {0, 1, 3}, points({a, b, {5, 0, 0}, {-6, 0, 0}})));  // beyond either
}
