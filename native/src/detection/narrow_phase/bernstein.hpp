// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace stiv {

/// A polynomial of some degree on [0, 1] by its Bernstein coefficients, which bound it and whose changes of sign count
/// its roots from above. Coefficients are numbers or vectors.
template <std::size_t degree, class Value = double>
using Bernstein = std::array<Value, degree + 1>;

constexpr double binomial(std::size_t n, std::size_t k) {
  double result = 1;
  for (std::size_t i = 0; i < k; ++i) result = result * static_cast<double>(n - i) / static_cast<double>(i + 1);
  return result;
}

/// The product of two polynomials under any product of their values. [Farouki, Rajan 1988, Eq. 44]
template <std::size_t m, std::size_t n, class A, class B, class Product>
auto multiply(const std::array<A, m>& a, const std::array<B, n>& b, const Product& product) {
  constexpr std::size_t degree = m + n - 2;
  using Value = decltype(product(a[0], b[0]));
  Bernstein<degree, Value> result;
  for (std::size_t k = 0; k <= degree; ++k) {
    const std::size_t first = k < n ? 0 : k - n + 1;
    const auto term = [&](std::size_t i) {
      return Value(product(a[i], b[k - i]) * (binomial(m - 1, i) * binomial(n - 1, k - i) / binomial(degree, k)));
    };
    result[k] = term(first);
    for (std::size_t i = first + 1; i < m && i <= k; ++i) result[k] += term(i);
  }
  return result;
}

/// Roots in [0, 1], ascending, to a few units in the last place of 1. Where the polynomial touches zero without a
/// change of sign that doubles can see, it has a root if its coefficients have changes of sign down to an interval of
/// 2^-40.
std::vector<double> roots(const Bernstein<3>& polynomial);
std::vector<double> roots(const Bernstein<6>& polynomial);

}  // namespace stiv
