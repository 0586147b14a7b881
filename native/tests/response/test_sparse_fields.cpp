// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>

#include "response/sparse_fields.hpp"

using namespace stiv;

namespace {

/// Entries at `first`, `first` + 1, ... up to `end`, each with the given probability.
SparseField some_field(Index first, Index end, double probability, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  SparseField field;
  for (Index k = first; k < end; ++k) {
    if (unit(random) > probability) continue;
    field.index.push_back(k);
    field.value.push_back(Vector3(unit(random), -unit(random), unit(random) - 0.5));
  }
  return field;
}

double product_entry_by_entry(const SparseField& a, const SparseField& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.index.size(); ++i)
    for (std::size_t j = 0; j < b.index.size(); ++j)
      if (a.index[i] == b.index[j]) sum += a.value[i].dot(b.value[j]);
  return sum;
}

}  // namespace

TEST_CASE("sparse fields: products equal those of all entries in order, bit for bit, with and without gaps") {
  std::mt19937 random(3);
  std::uniform_int_distribution<Index> place(0, 40);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Index a = place(random), b = place(random);
    const SparseField sparse = some_field(a, a + place(random), 0.4, random);
    for (const double probability : {0.0, 0.4, 1.0}) {
      const SparseField other = some_field(b, b + place(random), probability, random);
      CHECK(dot(sparse, other) == product_entry_by_entry(sparse, other));
      CHECK(dot(other, sparse) == product_entry_by_entry(other, sparse));
    }
  }
}
