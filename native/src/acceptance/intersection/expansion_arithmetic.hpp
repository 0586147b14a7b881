// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "error_free.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// A number as an exact sum of nonadjacent doubles, smallest first, without zeros. The last term has its sign. All
/// operations preserve this form under rounding to even. [Shewchuk 1997, section 2]
template <int Capacity>
struct Expansion {
  std::array<double, static_cast<std::size_t>(Capacity)> term;
  int size = 0;

  double operator[](int k) const { return term[at(k)]; }

  void append(double value) {
    if (value != 0) term[at(size++)] = value;
  }

  /// Adds one double. [theorem 10, GROW-EXPANSION]
  void grow(double value) {
    const int terms = size;
    size = 0;
    for (int k = 0; k < terms; ++k) {
      const Rounded sum = two_sum(value, (*this)[k]);
      append(sum.low);
      value = sum.high;
    }
    append(value);
  }

  int sign() const { return size == 0 ? 0 : ((*this)[size - 1] > 0 ? 1 : -1); }
};

/// x - y.
inline Expansion<2> exact_difference(double x, double y) {
  const Rounded difference = two_sum(x, -y);
  Expansion<2> result;
  result.append(difference.low);
  result.append(difference.high);
  return result;
}

template <int N>
Expansion<N> operator-(Expansion<N> e) {
  for (int k = 0; k < e.size; ++k) e.term[at(k)] *= -1;
  return e;
}

/// [theorem 12, EXPANSION-SUM: unlike the linear-time sum, it requires no more than nonadjacent terms]
template <int N, int M>
Expansion<N + M> operator+(const Expansion<N>& e, const Expansion<M>& f) {
  Expansion<N + M> sum;
  for (int k = 0; k < e.size; ++k) sum.append(e[k]);
  for (int k = 0; k < f.size; ++k) sum.grow(f[k]);
  return sum;
}

template <int N, int M>
Expansion<N + M> operator-(const Expansion<N>& e, const Expansion<M>& f) {
  return e + (-f);
}

/// [theorem 19, SCALE-EXPANSION]
template <int N>
Expansion<2 * N> operator*(const Expansion<N>& e, double factor) {
  Expansion<2 * N> scaled;
  double carry = 0;
  for (int k = 0; k < e.size; ++k) {
    const Rounded product = two_product(e[k], factor);
    const Rounded sum = two_sum(carry, product.low);
    const Rounded next = fast_two_sum(product.high, sum.high);
    scaled.append(sum.low);
    scaled.append(next.low);
    carry = next.high;
  }
  scaled.append(carry);
  return scaled;
}

/// Product with a difference of two doubles.
template <int N>
Expansion<4 * N> operator*(const Expansion<N>& e, const Expansion<2>& f) {
  Expansion<4 * N> product;
  for (int k = 0; k < f.size; ++k) {
    const Expansion<2 * N> part = e * f[k];
    for (int j = 0; j < part.size; ++j) product.grow(part[j]);
  }
  return product;
}

}  // namespace stiv
