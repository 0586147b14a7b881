// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>

#include "acceptance/intersection/separating_plane_filter.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "vector_targets.hpp"

using namespace stiv;

namespace {

/// Pairs of triangles without shared corners, six rows for each pair.
struct Batch {
  Positions q;
  TrianglePairs pairs;

  explicit Batch(const Positions& rows) : q(rows) {
    for (Index row = 0; row + 5 < q.rows(); row += 6) pairs.add({row, row + 1, row + 2}, {row + 3, row + 4, row + 5});
  }
  bool meets(std::size_t k) const {
    const auto row = static_cast<Index>(6 * k);
    return triangles_intersect({row, row + 1, row + 2}, {row + 3, row + 4, row + 5}, q);
  }
};

Positions random_corners(std::mt19937& random, int reach, bool integer) {
  Positions q(6 * static_cast<Index>(TrianglePairs::capacity), 3);
  std::uniform_real_distribution<double> real(-reach, reach);
  for (Index row = 0; row < q.rows(); ++row)
    for (Index axis = 0; axis < 3; ++axis) q(row, axis) = integer ? std::round(real(random)) : real(random);
  return q;
}

std::vector<unsigned char> separated(const Batch& batch, double reach = 0) {
  TriangleFlags flags{};
  PackedPoints points;
  for (const auto& row : batch.q.rowwise()) points.push_back({{row[0], row[1], row[2], 0}});
  find_separated(batch.pairs, points, reach, flags);
  return {flags.begin(), flags.begin() + static_cast<std::ptrdiff_t>(batch.pairs.count)};
}

}  // namespace

TEST_CASE("separating plane filter: separated pairs do not intersect, and all vector targets agree") {
  std::mt19937 random(3);
  int apart = 0, meeting = 0;
  for (int round = 0; round < 200; ++round) {
    Positions q = random_corners(random, 2 + round % 4, round % 2 == 0);
    if (round % 3 == 0) q.col(2) = 0.3 * q.col(0) - 0.7 * q.col(1);  // coplanar up to rounding
    if (round % 5 == 0) q *= round % 2 ? 1e-7 : 1e7;
    const Batch batch(q);
    const auto results = for_each_vector_target([&] { return separated(batch); });
    for (const auto& result : results) CHECK(result == results.front());
    for (std::size_t k = 0; k < batch.pairs.count; ++k) {
      const bool meets = batch.meets(k);
      if (results.front()[k]) CHECK_FALSE(meets);
      apart += results.front()[k];
      meeting += meets;
    }
  }
  CHECK(apart > 1000);
  CHECK(meeting > 1000);
}

TEST_CASE("separating plane filter: pairs that are separated by a reach do not intersect within it") {
  std::mt19937 random(4);
  int apart = 0, meeting = 0;
  for (int round = 0; round < 200; ++round) {
    const double scale = round % 2 == 0 ? 1 : (round % 4 == 1 ? 1e-7 : 1e7), reach = 0.2 * (1 + round % 3) * scale;
    const Positions q = scale * random_corners(random, 2, round % 5 == 0);
    const auto result = separated(Batch(q), reach);
    Positions moved = q;
    for (double& value : moved.reshaped()) value += random() % 2 == 0 ? reach : -reach;
    const Batch batch(moved);
    for (std::size_t k = 0; k < batch.pairs.count; ++k) {
      if (result[k]) CHECK_FALSE(batch.meets(k));
      apart += result[k];
      meeting += batch.meets(k);
    }
  }
  CHECK(apart > 1000);
  CHECK(meeting > 1000);
}

TEST_CASE("separating plane filter: each kind of plane is tried") {
  Positions q(18, 3);
  q << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 5, 1, 0, 5, 0, 1, 5,    // across the line between the centers
      0, 0, 0, 9, 0, 0, 0, 9, 0, 1, 1, 0.1, 8, 0, 4, 8, -9, 4,  // above the first
      0, 0, 0, 4, 0, 0, 0, 4, 0, 3, 3, 0, 6, -4, 0, 9, 3, 0;    // in one plane, over an edge
  CHECK(separated(Batch(q)) == std::vector<unsigned char>{1, 1, 1});
}

TEST_CASE("separating plane filter: touching, coincident, degenerate and overflowing pairs are inconclusive") {
  Positions q(30, 3);
  q << 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 0, 1, 1, 1, 2, 1, 1,  // vertex on face
      0, 0, 0, 4, 0, 0, 0, 4, 0, 4, 0, 0, 9, 0, 0, 9, 1, 0,   // corner on corner
      1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,   // all one point
      0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0,   // a point at the end of a segment
      0, 0, 0, 1e300, 0, 0, 0, 1e300, 0, 1, 1, -1, 1, 1, 1, 1e300, 1e300, 1;
  CHECK(separated(Batch(q)) == std::vector<unsigned char>(5, 0));
}
