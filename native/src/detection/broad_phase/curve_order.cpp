// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/curve_order.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "detection/broad_phase/curve_places.hpp"

namespace stiv {

namespace {

/// Halves, because a difference may overflow.
CellScale scale_of(std::span<const NumberedPoint> points) {
  std::array<float, 3> low = points[0].position, high = low;
  for (const NumberedPoint& point : points)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], point.position[axis]);
      high[axis] = std::max(high[axis], point.position[axis]);
    }
  float extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, high[axis] / 2 - low[axis] / 2);
  return {low, static_cast<float>(curve_side) / extent};
}

/// Sorts by place; ties keep their order. A digit at a time, the lowest first.
void sort_by_place(LargeArray<CurveEntry>& entries) {
  std::array<std::array<std::uint32_t, curve_side>, 3> starts{};
  for (const CurveEntry& entry : entries)
    for (std::size_t digit = 0; digit < 3; ++digit)
      ++starts[digit][entry.place >> digit * curve_bits & (curve_side - 1)];
  LargeArray<CurveEntry> sorted(entries.size());
  for (std::size_t digit = 0; digit < 3; ++digit) {
    std::uint32_t sum = 0;
    for (std::uint32_t& start : starts[digit]) sum += std::exchange(start, sum);
    for (const CurveEntry& entry : entries)
      sorted[starts[digit][entry.place >> digit * curve_bits & (curve_side - 1)]++] = entry;
    std::swap(entries, sorted);
  }
}

}  // namespace

void sort_along_curve(std::span<NumberedPoint> points) {
  constexpr std::size_t few = 64;
  if (points.size() < 2) return;
  LargeArray<CurveEntry> entries(points.size());
  find_places(points, scale_of(points), entries.data());
  sort_by_place(entries);
  const NumberedPoints before(points.begin(), points.end());
  for (std::size_t k = 0; k < points.size(); ++k) points[k] = before[entries[k].point];
  if (entries.front().place == entries.back().place) return;
  // A cell that holds many points is a small part of the cube: these are sorted in a cube of their own.
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    while (end < points.size() && entries[end].place == entries[begin].place) ++end;
    if (end - begin > few) sort_along_curve(points.subspan(begin, end - begin));
  }
}

}  // namespace stiv
