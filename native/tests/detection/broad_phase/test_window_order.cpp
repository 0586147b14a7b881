// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "detection/broad_phase/window_order.hpp"
#include "vector_targets.hpp"

using namespace stiv;

namespace {

using Points = std::vector<NumberedPoint>;

Points random_points(std::size_t count, unsigned seed, float scale) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(-1, 1);
  Points points;
  for (std::size_t k = 0; k < count; ++k)
    points.push_back(
        {{3 * scale * number(random), scale * number(random), 2 * scale * number(random)}, static_cast<Index>(k)});
  return points;
}

std::vector<Index> numbers_of(const Points& points) {
  std::vector<Index> numbers;
  for (const NumberedPoint& point : points) numbers.push_back(point.number);
  return numbers;
}

}  // namespace

TEST_CASE("window order: halves are split along the longest axis, and all vector targets give the same order") {
  for (std::size_t count = 1; count <= window_capacity; ++count) {
    const Points given = random_points(count, static_cast<unsigned>(count), 1);
    const auto orders = for_each_vector_target([&] {
      Points points = given;
      order_window(points, 8);
      return numbers_of(points);
    });
    for (const auto& order : orders) CHECK(order == orders.front());
    CHECK(std::set<Index>(orders[0].begin(), orders[0].end()).size() == count);
    if (count <= 8) continue;
    const std::size_t half = size_of_first_part(count, 8);
    std::vector<std::pair<float, Index>> along;  // x is the longest axis of these
    for (const NumberedPoint& point : given) along.emplace_back(point.position[0], point.number);
    std::sort(along.begin(), along.end());
    std::set<Index> expected, found(orders[0].begin(), orders[0].begin() + static_cast<std::ptrdiff_t>(half));
    for (std::size_t k = 0; k < half; ++k) expected.insert(along[k].second);
    if (count >= 24) CHECK(found == expected);
  }
}

TEST_CASE("window order: halves of points in any order and of any spread, as sorted by position and index") {
  std::mt19937 random(4);
  std::normal_distribution<float> spread(0, 3);
  const auto height = [](std::size_t k) { return static_cast<float>(k); };
  const std::vector<std::function<float(std::size_t)>> positions{
      [&](std::size_t) { return std::round(spread(random)) + 0.5F; },
      height,
      [&](std::size_t k) { return -height(k); },
      [&](std::size_t k) { return height(std::min(k, 500 - std::min<std::size_t>(k, 500))); },
      [&](std::size_t k) { return k == 3 ? 1e30F : -1.0F; },
      [&](std::size_t k) { return std::ldexp(1.0F, static_cast<int>(k % 20)); },
      [&](std::size_t) { return 2.0F; }};
  for (const std::size_t count : {9U, 16U, 17U, 32U, 33U, 100U, 511U, 513U, 1024U})
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const auto& position : positions) {
        Points points;
        for (std::size_t k = 0; k < count; ++k) {
          const float along = position(k);
          points.push_back({{0.1F * along, 0.1F * along, 0.1F * along}, static_cast<Index>(k)});
          points.back().position[axis] = along;
        }
        Points sorted = points;
        std::stable_sort(sorted.begin(), sorted.end(), [&](const NumberedPoint& a, const NumberedPoint& b) {
          return a.position[axis] < b.position[axis];
        });
        order_window(points, 8);
        const auto half = static_cast<std::ptrdiff_t>(size_of_first_part(count, 8));
        std::vector<Index> found = numbers_of(points), expected = numbers_of(sorted);
        for (std::vector<Index>* numbers : {&found, &expected}) {
          std::sort(numbers->begin(), numbers->begin() + half);
          std::sort(numbers->begin() + half, numbers->end());
        }
        CHECK(found == expected);
      }
}

TEST_CASE("window order: the first part ends where nodes end") {
  CHECK(size_of_first_part(9, 8) == 8);
  CHECK(size_of_first_part(16, 8) == 8);
  CHECK(size_of_first_part(17, 8) == 16);
  CHECK(size_of_first_part(64, 8) == 32);
}

TEST_CASE("window order: coincident points and extreme numbers") {
  constexpr float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
  for (const float extreme : {0.0F, 1.0F, most, least}) {
    Points points;
    for (Index k = 0; k < 40; ++k) points.push_back({{k % 2 == 0 ? extreme : -extreme, extreme, 0}, k});
    order_window(points, 8);
    const std::vector<Index> numbers = numbers_of(points);
    CHECK(std::set<Index>(numbers.begin(), numbers.end()).size() == 40);
    for (std::size_t k = 1; k < 20; ++k)
      if (extreme >= 1) CHECK(points[k].position == points[0].position);
  }
}
