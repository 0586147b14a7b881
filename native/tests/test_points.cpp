// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/points.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "deformation/finite_differences.hpp"
#include "stiv/error.hpp"

using namespace stiv;

namespace {

SinglePositions random_points(Index count, unsigned seed) {
  return (3 * testing::random_positions(count, seed)).cast<float>();
}

/// A quad with a square base whose last corner is `height` above the plane of the others.
SinglePositions quad(float height) {
  SinglePositions points(4, 3);
  points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, height;
  return points;
}

bool is_folded(const SinglePositions& points, float cosine, float narrow = 0x1p-18F) {
  QuadCorners corners(4, 1);
  corners << 0, 1, 2, 3;
  return !find_folded(points, corners, cosine, narrow).empty();
}

}  // namespace

TEST_CASE("points in single and double precision map alike, each coordinate rounded in one order") {
  AffineMap map;
  map << 0.3, -1.7, 2.9, 10, 1e-3, 5, -0.25, -7, 0.1, 0.2, 0.7, 1e6;
  const SinglePositions points = random_points(1000, 1);
  const Positions doubles = points.cast<double>(), mapped = transform_points(map, SinglePositionsView(points));
  CHECK(mapped == transform_points(map, PositionsView(doubles)));
  for (Index row = 0; row < points.rows(); ++row)
    for (Index k = 0; k < 3; ++k) {
      const double x = map(k, 0) * doubles(row, 0), y = map(k, 1) * doubles(row, 1), z = map(k, 2) * doubles(row, 2);
      CHECK(mapped(row, k) == ((x + z) + y) + map(k, 3));
    }
}

TEST_CASE("the largest difference of two lists of points") {
  const Positions first = random_points(101, 2).cast<double>();
  Positions second = first;
  CHECK(largest_difference(first, second) == 0);
  second(100, 2) -= 0.5;
  CHECK(largest_difference(first, second) == std::abs(first(100, 2) - second(100, 2)));
  second(7, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(largest_difference(first, second)));
  CHECK_THROWS_AS(largest_difference(first, second.topRows(100)), InputError);
  CHECK(largest_difference(first.topRows(0), second.topRows(0)) == 0);
}

TEST_CASE("quads that are open, bent, folded, narrow, or not numbers") {
  CHECK_FALSE(is_folded(quad(0), 0.7F));
  CHECK(is_folded(quad(2), 0.7F));  // the cosine of the angle is a half
  CHECK_FALSE(is_folded(quad(2), 0.3F));
  SinglePositions folded = quad(0);
  folded.row(3) << 1, 0.5, 0;
  CHECK(is_folded(folded, 1e-3F));
  SinglePositions narrow = quad(0);
  narrow.row(3) << 0.499F, 0.5, 0;
  CHECK_FALSE(is_folded(narrow, 1e-3F));
  CHECK(is_folded(narrow, 1e-3F, 0.01F));
  SinglePositions nothing = quad(0);
  nothing(1, 0) = std::numeric_limits<float>::quiet_NaN();
  CHECK(is_folded(nothing, 1e-3F));
}

TEST_CASE("each quad of many is tested as it would be alone") {
  const SinglePositions points = random_points(148, 3);
  QuadCorners corners(4, 37);  // two full blocks and a part
  for (Index k = 0; k < 37; ++k) corners.col(k) << 4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3;
  std::vector<Index> alone;
  for (Index k = 0; k < 37; ++k)
    if (is_folded(points.middleRows(4 * k, 4), 0.5F, 0)) alone.push_back(k);
  CHECK(find_folded(points, corners, 0.5F, 0) == alone);
  CHECK(!alone.empty());
  CHECK(alone.size() < 37);
  corners(2, 5) = 148;
  CHECK_THROWS_AS(find_folded(points, corners, 0.5F, 0), InputError);
}
