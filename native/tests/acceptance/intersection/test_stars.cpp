// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <random>

#include "acceptance/intersection/stars.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "vector_targets.hpp"

using namespace stiv;

namespace {

using CornerRows = std::vector<std::array<Index, 3>>;

/// Vertex 0 within `count` others; closed or open by one triangle.
CornerRows fan(Index count, bool closed) {
  CornerRows triangles;
  for (Index k = 0; k < (closed ? count : count - 1); ++k) triangles.push_back({0, 1 + k, 1 + (k + 1) % count});
  return triangles;
}

/// The center, and `count` points around it that turn by `turn` in total, each `rise` higher than the last.
Positions around(Index count, double turn, double rise = 0) {
  Positions q = Positions::Zero(count + 1, 3);
  for (Index k = 0; k < count; ++k) {
    const double angle = turn * 2 * std::numbers::pi * k / count;
    q.row(k + 1) << std::cos(angle), std::sin(angle), rise * k;
  }
  return q;
}

/// Rotated, shuffled corners: the order of triangles and which corner comes first mean nothing.
CornerRows shuffled(CornerRows triangles, std::mt19937& random) {
  std::shuffle(triangles.begin(), triangles.end(), random);
  for (auto& corners : triangles)
    std::rotate(corners.begin(), corners.begin() + static_cast<int>(random() % 3), corners.end());
  return triangles;
}

bool any_pair_intersects(const CornerRows& triangles, const Positions& q) {
  for (std::size_t a = 0; a < triangles.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (triangles_intersect(triangles[a], triangles[b], q)) return true;
  return false;
}

std::vector<unsigned char> find_free(const Stars& stars, const Positions& q, const std::vector<unsigned char>& moved,
                                     double reach = 0) {
  const Execution execution(2);
  SurfaceDefinition points;
  points.vertex_count = static_cast<Index>(q.rows());
  const Surface surface(std::move(points));
  PlacedVertices placed(surface);
  placed.update(q, moved, 0, execution);
  std::vector<unsigned char> free;
  stars.find_free(placed, moved, reach, free, execution);
  return free;
}

/// The star of vertex 0, with any vector target.
bool proven(const CornerRows& triangles, const Positions& q) {
  const Stars stars(triangles, static_cast<Index>(q.rows()));
  const auto results = for_each_vector_target([&] { return find_free(stars, q, {})[0]; });
  for (const unsigned char result : results) CHECK(result == results.front());
  return results.front() != 0;
}

}  // namespace

TEST_CASE("stars: flat and raised fans are proven free, closed or open, at any scale and orientation") {
  std::mt19937 random(1);
  for (const double scale : {1e-7, 1.0, 1e7}) {
    for (const Index count : {3, 6, 31}) {
      for (const bool closed : {true, false}) {
        Positions q = scale * around(count, 1);
        CHECK(proven(shuffled(fan(count, closed), random), q));
        q.row(0) += scale * Eigen::RowVector3d(0.2, -0.1, 0.7);
        CHECK(proven(shuffled(fan(count, closed), random), q));
        q.col(2) *= -1;
        q.rowwise() += Eigen::RowVector3d(3, 5, -7) * scale;
        CHECK(proven(shuffled(fan(count, closed), random), q));
      }
    }
  }
}

TEST_CASE("stars: fans that turn more than once are not proven") {
  CHECK_FALSE(proven(fan(12, true), around(12, 2)));           // twice around, covers itself
  CHECK_FALSE(proven(fan(12, false), around(12, 1.3)));        // flat, covers its own start
  CHECK_FALSE(proven(fan(12, false), around(12, 1.3, 0.1)));   // above its own start: free, but not provably
  CHECK_FALSE(proven(fan(13, false), around(13, 13.0 / 12)));  // ends exactly where it starts, at another vertex
}

TEST_CASE("stars: flat folds, degenerate triangles and several fans are not proven") {
  Positions q = around(6, 1);
  q.row(3) = q.row(2);
  CHECK_FALSE(proven(fan(6, true), q));
  q = around(6, 1);
  q.row(0) = q.row(1) + q.row(2);  // outside its own link
  CHECK_FALSE(proven(fan(6, true), q));
  q = around(6, 1);
  CHECK_FALSE(proven({{0, 1, 2}, {0, 3, 4}}, q));             // two fans
  CHECK_FALSE(proven({{0, 1, 2}, {0, 2, 3}, {0, 2, 4}}, q));  // three triangles at an edge
  CHECK_FALSE(proven({{0, 1, 2}, {0, 3, 2}}, q));             // with opposite orientations
  CHECK_FALSE(proven({{0, 1, 2}, {0, 2, 1}}, q));             // both sides of one
  CHECK_FALSE(proven({{0, 1, 2}, {0, 1, 2}}, q));             // twice the same
  CHECK_FALSE(proven({{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}}, q));  // two closed fans
  CHECK_FALSE(proven({{0, 0, 1}}, q));
  CHECK_FALSE(proven({{1, 2, 3}}, q));
  CHECK_FALSE(proven(fan(64, true), around(64, 1)));  // more than the proof accepts
}

TEST_CASE("stars: proven stars have no intersecting pair") {
  std::mt19937 random(2);
  int free = 0, meeting = 0;
  for (int round = 0; round < 20000; ++round) {
    const auto count = static_cast<Index>(3 + random() % 5);
    const bool closed = random() % 2 == 0;
    const int reach = 1 + static_cast<int>(random() % 4);
    Positions q(count + 1, 3);
    for (Index row = 0; row <= count; ++row)
      for (Index axis = 0; axis < 3; ++axis) q(row, axis) = std::uniform_int_distribution(-reach, reach)(random);
    if (random() % 3 == 0) q.col(2) *= 0.25;  // flatter: more stars are free
    const CornerRows triangles = shuffled(fan(count, closed), random);
    const bool meets = any_pair_intersects(triangles, q);
    if (proven(triangles, q)) {
      CHECK_FALSE(meets);
      ++free;
    }
    meeting += meets;
  }
  CHECK(free > 500);
  CHECK(meeting > 5000);
}

TEST_CASE("stars: only stars with a moved vertex are tested") {
  Positions q = around(6, 1);
  const Stars stars(fan(6, true), 7);
  const std::vector<unsigned char> all = find_free(stars, q, {});
  CHECK(all == std::vector<unsigned char>(7, 1));
  CHECK(find_free(stars, q, std::vector<unsigned char>(7, 0)) == std::vector<unsigned char>(7, 0));
  std::vector<unsigned char> moved(7, 0);
  moved[1] = 1;  // its own star, the center's and those of both neighbors
  CHECK(find_free(stars, q, moved) == std::vector<unsigned char>{1, 1, 1, 0, 0, 0, 1});
}

TEST_CASE("stars: blocks of several shapes give the results of single stars") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  CornerRows all;
  std::vector<unsigned char> expected;
  Positions q(0, 3);
  std::vector<Index> centres;
  for (int star = 0; star < 300; ++star) {
    const auto count = static_cast<Index>(3 + random() % 6), first = static_cast<Index>(q.rows());
    const CornerRows triangles = fan(count, random() % 2 == 0);
    Positions own = around(count, 1);
    for (Index row = 0; row <= count; ++row)
      own.row(row) += (star % 3) * 0.4 * Eigen::RowVector3d(number(random), number(random), number(random));
    expected.push_back(proven(triangles, own));
    centres.push_back(first);
    for (const auto& [a, b, c] : triangles) all.push_back({first + a, first + b, first + c});
    q.conservativeResize(first + own.rows(), 3);
    q.bottomRows(own.rows()) = own;
  }
  const std::vector<unsigned char> found = find_free(Stars(all, static_cast<Index>(q.rows())), q, {});
  for (std::size_t star = 0; star < centres.size(); ++star)
    CHECK(found[static_cast<std::size_t>(centres[star])] == expected[star]);
  CHECK(std::count(expected.begin(), expected.end(), 1) > 100);
  CHECK(std::count(expected.begin(), expected.end(), 0) > 50);
}

TEST_CASE("stars: those that are free within a reach have no intersecting pair wherever their points differ by it") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  int proven = 0, open = 0, meeting = 0;
  for (int round = 0; round < 3000; ++round) {
    const double scale = round % 3 == 0 ? 1 : (round % 3 == 1 ? 1e-7 : 1e7);
    const double reach = scale * 0.8 * std::pow(unit(random), 4);
    const Index count = 3 + static_cast<Index>(random() % 6);
    const bool closed = random() % 2 == 0;
    const CornerRows triangles = fan(count, closed);
    const Positions q = scale * around(count, closed ? 1 : 0.9, 0.3 * unit(random));
    const auto proof = find_free(Stars(triangles, count + 1), q, {}, reach)[0];
    Positions moved = q;
    for (double& value : moved.reshaped()) value += random() % 2 == 0 ? reach : -reach;
    const bool meets = any_pair_intersects(triangles, moved);
    if (proof == Stars::free_within_reach) CHECK_FALSE(meets);
    proven += proof == Stars::free_within_reach;
    open += proof == Stars::free_here;
    meeting += meets;
  }
  CHECK(proven > 100);
  CHECK(open > 100);
  CHECK(meeting > 100);
}
