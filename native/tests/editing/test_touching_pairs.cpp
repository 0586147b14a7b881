// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/touching_pairs.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "acceptance/clearance/triangle_distance.hpp"

using namespace stiv;

namespace {

/// Two triangles with 0, 1 or 2 common corners: the second uses the last corners of the first.
struct Pair {
  std::array<Index, 3> first{0, 1, 2}, second;
  Positions q;
};

Pair random_pair(Index shared, std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1, 1), flat(-1e-5, 1e-5);
  Pair pair;
  pair.q.resize(6 - shared, 3);
  for (Index row = 0; row < pair.q.rows(); ++row)
    pair.q.row(row) << coordinate(random), coordinate(random), flat(random);
  for (Index k = 0; k < 3; ++k) pair.second[at(k)] = 3 - shared + k;
  return pair;
}

std::shared_ptr<const Surface> surface_of(const Pair& pair) {
  Triangles triangles(2, 3);
  for (Index k = 0; k < 3; ++k) {
    triangles(0, k) = pair.first[at(k)];
    triangles(1, k) = pair.second[at(k)];
  }
  SurfaceDefinition definition;
  definition.vertex_count = static_cast<Index>(pair.q.rows());
  definition.triangles = triangles;
  return std::make_shared<const Surface>(std::move(definition));
}

bool touch(const Pair& pair, double distance) {
  Execution execution(1);
  return !find_touching(surface_of(pair), {{0, 0}}, pair.q, distance, execution).empty();
}

Positions deviating(const Positions& q, double most, std::mt19937& random) {
  std::uniform_real_distribution<double> offset(-most, most);
  return q + Positions::NullaryExpr(q.rows(), 3, [&] { return offset(random); });
}

}  // namespace

TEST_CASE("touching pairs: no other pair intersects after a motion as short as rounding") {
  std::mt19937 random(5);
  constexpr double rounding = 2e-8;
  int changed = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Pair pair = random_pair(trial % 3, random);
    Pair near = pair;
    near.q.col(2) *= 1e-3;  // within the rounding of a plane
    if (triangles_intersect(near.first, near.second, near.q)) continue;
    for (int motion = 0; motion < 4; ++motion) {
      const Positions moved = deviating(near.q, rounding, random);
      if (!triangles_intersect(near.first, near.second, moved)) continue;
      ++changed;
      CHECK(touch(near, 1e-6));
    }
  }
  CHECK(changed > 200);
}

TEST_CASE("touching pairs: corners of slivers in one line") {
  Pair pair;
  pair.second = {3, 1, 2};
  pair.q.resize(4, 3);
  pair.q << -8.1e-10, 0, 0.0185, 7.5e-10, 0, -0.0172, 5.7e-11, 0, -0.0013, 5.8e-10, 0, -0.0132;
  REQUIRE(!triangles_intersect(pair.first, pair.second, pair.q));
  CHECK(touch(pair, 1e-6));
}

TEST_CASE("touching pairs: all nearer than a distance, however long it is") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-4, 0);
  int near = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Pair pair = random_pair(0, random);
    pair.q.col(2) *= 1e5;
    if (triangles_intersect(pair.first, pair.second, pair.q)) continue;
    const double distance = std::pow(10, exponent(random));
    const bool is_near = triangle_distance(pair.first, pair.second, pair.q).distance < distance;
    near += is_near;
    CHECK(touch(pair, distance) == is_near);
  }
  CHECK(near > 200);
}

TEST_CASE("touching pairs: pairs that are apart, or intersect, do not touch") {
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    Pair pair = random_pair(trial % 3, random);
    pair.q.col(2) *= 1e5;
    const bool intersects = triangles_intersect(pair.first, pair.second, pair.q);
    if (touch(pair, 1e-9)) CHECK(!intersects);
    if (intersects) CHECK(!touch(pair, 1));
  }
}

TEST_CASE("intersection depth: no shorter motion parts two triangles, and some motion of that length does") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  int intersecting = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Pair pair = random_pair(0, random);
    pair.q.col(2) *= 1e5;
    if (!triangles_intersect(pair.first, pair.second, pair.q)) continue;
    ++intersecting;
    const double depth = intersection_depth(pair.first, pair.second, pair.q);
    for (int direction = 0; direction < 8; ++direction) {
      const Eigen::RowVector3d way = Eigen::RowVector3d(normal(random), normal(random), normal(random)).normalized();
      Positions moved = pair.q;
      moved.bottomRows(3).rowwise() += (0.999 * depth) * way;
      CHECK(triangles_intersect(pair.first, pair.second, moved));
    }
  }
  CHECK(intersecting > 200);
}
