// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/corner_order.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace stiv {

namespace {

template <Index size>
Index key_of(const Index* row, std::span<const Index> places) {
  const Index a = places[row[0]], b = places[row[1]];
  if constexpr (size == 2) return std::min(a, b);
  const Index c = places[row[2]];
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

/// A counting sort; primitives with equal keys keep their order.
template <Index size>
LargeArray<Index> sorted(const Index* rows, Index count, std::span<const Index> places) {
  LargeArray<Index> keys(at(count)), starts(places.size(), 0), order(at(count));
  for (Index primitive = 0; primitive < count; ++primitive) {
    keys[primitive] = key_of<size>(rows + static_cast<std::ptrdiff_t>(primitive) * size, places);
    ++starts[keys[primitive]];
  }
  Index sum = 0;
  for (Index& start : starts) sum += std::exchange(start, sum);
  for (Index primitive = 0; primitive < count; ++primitive) order[starts[keys[primitive]]++] = primitive;
  return order;
}

}  // namespace

LargeArray<Index> order_by_corners(const Index* rows, Index count, Index size, std::span<const Index> places) {
  return size == 2 ? sorted<2>(rows, count, places) : sorted<3>(rows, count, places);
}

}  // namespace stiv
