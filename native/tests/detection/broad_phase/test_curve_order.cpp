// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "detection/broad_phase/curve_order.hpp"
#include "vector_targets.hpp"

using namespace stiv;

namespace {

using Points = std::vector<NumberedPoint>;

/// A point in each cell of a cube of `side` cells, in random order.
Points grid(Index side, float scale) {
  Points points;
  for (Index k = 0; k < side * side * side; ++k) {
    const Index x = k % side, y = k / side % side, z = k / (side * side);
    points.push_back(
        {{scale * static_cast<float>(x), scale * static_cast<float>(y), scale * static_cast<float>(z)}, k});
  }
  std::mt19937 random(2);
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

float distance(const NumberedPoint& a, const NumberedPoint& b) {
  float sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) sum += std::abs(a.position[axis] - b.position[axis]);
  return sum;
}

std::vector<Index> sorted_numbers(const Points& points) {
  std::vector<Index> numbers;
  for (const NumberedPoint& point : points) numbers.push_back(point.number);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace

TEST_CASE("curve order: of a full grid, each point is a neighbour of the last one, which defines a Hilbert curve") {
  for (const float scale : {1.0F, 1e-30F, 1e30F}) {
    Points points = grid(16, scale);
    const std::vector<Index> numbers = sorted_numbers(points);
    sort_along_curve(points);
    CHECK(sorted_numbers(points) == numbers);
    for (std::size_t k = 1; k < points.size(); ++k)
      REQUIRE(distance(points[k - 1], points[k]) == doctest::Approx(scale).epsilon(1e-5));
  }
}

TEST_CASE("curve order: points much closer together than the others are sorted too") {
  Points points = grid(8, 1e-6F);
  points.push_back({{1, 1, 1}, 8 * 8 * 8});
  sort_along_curve(points);
  for (std::size_t k = 1; k + 1 < points.size(); ++k) CHECK(distance(points[k - 1], points[k]) < 1.5e-6F);
}

TEST_CASE("curve order: coincident points, a single one, and extreme numbers") {
  Points none, one{{{1, 2, 3}, 7}}, same(500, {{1, 2, 3}, 0});
  sort_along_curve(none);
  sort_along_curve(one);
  for (std::size_t k = 0; k < same.size(); ++k) same[k].number = static_cast<Index>(k);
  sort_along_curve(same);
  for (std::size_t k = 0; k < same.size(); ++k) CHECK(same[k].number == static_cast<Index>(k));
  constexpr float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
  for (const float extreme : {most, least}) {
    Points points;
    for (Index k = 0; k < 300; ++k)
      points.push_back({{k % 2 == 0 ? extreme : -extreme, k % 3 == 0 ? extreme : -extreme, 0}, k});
    const std::vector<Index> numbers = sorted_numbers(points);
    sort_along_curve(points);
    CHECK(sorted_numbers(points) == numbers);
  }
}

TEST_CASE("curve order: all vector targets give the same order") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-1, 1);
  constexpr float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
  for (const float scale : {1.0F, most, 3 * least}) {
    for (const std::size_t count : {2, 63, 64, 65, 5000}) {
      Points given;
      for (std::size_t k = 0; k < count; ++k)
        given.push_back(
            {{scale * number(random), scale * number(random), scale * number(random)}, static_cast<Index>(k)});
      const auto orders = for_each_vector_target([&] {
        Points points = given;
        sort_along_curve(points);
        std::vector<Index> order;
        for (const NumberedPoint& point : points) order.push_back(point.number);
        return order;
      });
      for (const auto& order : orders) CHECK(order == orders.front());
    }
  }
}
