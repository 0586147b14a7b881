// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

#include "detection/broad_phase/median_split.hpp"

using namespace stiv;

namespace {

using Points = std::vector<NumberedPoint>;

/// Along x, the longest axis.
Points points_with(std::size_t count, const auto& x) {
  Points points;
  for (std::size_t k = 0; k < count; ++k) points.push_back({{x(k), 0.1F * x(k), 0}, static_cast<Index>(k)});
  return points;
}

std::vector<Index> numbers_of(auto begin, auto end) {
  std::vector<Index> numbers;
  std::transform(begin, end, std::back_inserter(numbers), [](const NumberedPoint& point) { return point.number; });
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

void check_against_sorting(Points points) {
  Points sorted = points;
  std::sort(sorted.begin(), sorted.end(), [](const NumberedPoint& a, const NumberedPoint& b) {
    return std::tie(a.position[0], a.number) < std::tie(b.position[0], b.number);
  });
  for (const std::size_t half : {points.size() / 2, points.size() / 7, points.size() - 1, std::size_t{1}}) {
    split_at_median(points, half);
    const auto middle = static_cast<std::ptrdiff_t>(half);
    CHECK(numbers_of(points.begin(), points.begin() + middle) == numbers_of(sorted.begin(), sorted.begin() + middle));
    CHECK(numbers_of(points.begin(), points.end()) == numbers_of(sorted.begin(), sorted.end()));
  }
}

}  // namespace

TEST_CASE("median split: the first half by position and number, whatever the order before") {
  std::mt19937 random(4);
  std::normal_distribution<float> spread(0, 3);
  for (const std::size_t count : {2U, 9U, 16U, 17U, 100U, 511U, 513U, 5000U}) {
    CAPTURE(count);
    const auto height = [](std::size_t k) { return static_cast<float>(k); };
    check_against_sorting(points_with(count, [&](std::size_t) { return spread(random); }));
    check_against_sorting(points_with(count, [&](std::size_t) { return std::round(spread(random)) + 0.5F; }));
    check_against_sorting(points_with(count, height));
    check_against_sorting(points_with(count, [&](std::size_t k) { return -height(k); }));
    check_against_sorting(points_with(count, [&](std::size_t k) { return height(std::min(k, count - k)); }));
    check_against_sorting(points_with(count, [&](std::size_t k) { return k == 3 ? 1e30F : -1.0F; }));
  }
}

TEST_CASE("median split: along the longest axis") {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Points points;
    for (Index k = 0; k < 60; ++k) {
      NumberedPoint point{{static_cast<float>(k % 7), static_cast<float>(k % 7), static_cast<float>(k % 7)}, k};
      point.position[axis] = static_cast<float>(-2 * k);
      points.push_back(point);
    }
    split_at_median(points, 20);
    CHECK(numbers_of(points.begin(), points.begin() + 20).front() == 40);
  }
}
