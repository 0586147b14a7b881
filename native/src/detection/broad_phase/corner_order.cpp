// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/corner_order.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "detection/broad_phase/curve_order.hpp"

namespace stiv {

namespace {

template <Index size>
Index key_of(const Index* row, const std::vector<Index>& places) {
  const Index a = places[row[0]];
  if constexpr (size == 1) return a;
  const Index b = places[row[1]];
  if constexpr (size == 2) return std::min(a, b);
  const Index c = places[row[2]];
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

/// A counting sort; primitives with equal keys keep their order.
template <Index size>
std::vector<Index> sorted(const Index* rows, Index count, const std::vector<Index>& places) {
  std::vector<Index> keys(count), starts(places.size(), 0), order(count);
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

std::vector<Index> places_along_curve(const std::vector<Eigen::Vector3f>& points) {
  std::vector<NumberedPoint> numbered;
  numbered.reserve(points.size());
  for (const Eigen::Vector3f& point : points)
    numbered.push_back({{point[0], point[1], point[2]}, static_cast<Index>(numbered.size())});
  sort_along_curve(numbered);
  std::vector<Index> places(points.size());
  for (std::size_t place = 0; place < numbered.size(); ++place)
    places[numbered[place].number] = static_cast<Index>(place);
  return places;
}

std::vector<Index> order_by_corners(const Index* rows, Index count, Index size, const std::vector<Index>& places) {
  if (size == 1) return sorted<1>(rows, count, places);
  if (size == 2) return sorted<2>(rows, count, places);
  return sorted<3>(rows, count, places);
}

}  // namespace stiv
