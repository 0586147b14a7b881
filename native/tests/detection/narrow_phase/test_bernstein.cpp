// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "detection/narrow_phase/bernstein.hpp"

using namespace stiv;

namespace {

/// t - root, as a polynomial of degree one.
Bernstein<1> factor(double root) { return {-root, 1 - root}; }

Bernstein<3> with_roots(double a, double b, double c) {
  return multiply(multiply(factor(a), factor(b), std::multiplies<>()), factor(c), std::multiplies<>());
}

}  // namespace

TEST_CASE("bernstein: the product has the product's values") {
  const Bernstein<2> a{1, -3, 2};
  const Bernstein<3> b{2, 0, 5, -1};
  const auto value = [](const auto& p, double t) {
    double sum = 0;
    const std::size_t n = p.size() - 1;
    for (std::size_t k = 0; k <= n; ++k)
      sum += p[k] * binomial(n, k) * std::pow(t, double(k)) * std::pow(1 - t, double(n - k));
    return sum;
  };
  const auto product = multiply(a, b, std::multiplies<>());
  for (double t = 0; t <= 1; t += 0.125) CHECK(value(product, t) == doctest::Approx(value(a, t) * value(b, t)));
}

TEST_CASE("bernstein: all roots within the unit interval are found, in order") {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> number(-0.5, 1.5);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> expected{number(random), number(random), number(random)};
    const std::vector<double> found = roots(with_roots(expected[0], expected[1], expected[2]));
    std::sort(expected.begin(), expected.end());
    std::erase_if(expected, [](double t) { return t < 0 || t > 1; });
    bool distinct = true;
    for (std::size_t k = 1; k < expected.size(); ++k) distinct = distinct && expected[k] - expected[k - 1] > 1e-3;
    if (!distinct) continue;
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) CHECK(found[k] == doctest::Approx(expected[k]).epsilon(1e-9));
  }
}

TEST_CASE("bernstein: degree six, with roots that nearly coincide") {
  const Bernstein<3> cubic = with_roots(0.25, 0.5, 0.75);
  Bernstein<6> polynomial = multiply(cubic, cubic, std::multiplies<>());
  for (double& coefficient : polynomial) coefficient -= 1e-14;  // each double root becomes two
  const auto found = roots(polynomial);
  REQUIRE(found.size() == 6);
  CHECK(std::is_sorted(found.begin(), found.end()));
  for (std::size_t k = 0; k < 6; ++k) CHECK(std::abs(found[k] - 0.25 * double(k / 2 + 1)) < 1e-5);
}

TEST_CASE("bernstein: roots at the ends, none, and zero") {
  CHECK(roots(with_roots(0, 1, 2)) == std::vector<double>{0, 1});
  CHECK(roots(with_roots(2, 3, 4)).empty());
  CHECK(roots(Bernstein<3>{}).empty());
  CHECK(roots(Bernstein<6>{1, 1, 1, 1, 1, 1, 1}).empty());
}
