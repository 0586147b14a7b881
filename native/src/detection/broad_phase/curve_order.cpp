// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/curve_order.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace stiv {

namespace {

/// The cube has 2^bits cells on each side.
constexpr unsigned bits = 10;
constexpr std::uint32_t side = 1U << bits;

/// A place on the curve and the index of a point.
struct Entry {
  std::uint32_t place;
  std::uint32_t point;
};

/// Cells of some points, as arrays over the points: compilers turn the loops below into vector code.
struct Cells {
  static constexpr std::size_t capacity = 64;
  std::array<std::array<std::uint32_t, capacity>, 3> axes{};
};

/// Points are mapped to cells after the least coordinates are subtracted. Halves, because a difference may overflow.
struct CellScale {
  std::array<float, 3> low{};
  float scale = 0;

  explicit CellScale(std::span<const NumberedPoint> points) {
    std::array<float, 3> high = low = points[0].position;
    for (const NumberedPoint& point : points)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], point.position[axis]);
        high[axis] = std::max(high[axis], point.position[axis]);
      }
    float extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, high[axis] / 2 - low[axis] / 2);
    scale = static_cast<float>(side) / extent;
  }

  std::uint32_t cell(const NumberedPoint& point, std::size_t axis) const {
    const float place = (point.position[axis] / 2 - low[axis] / 2) * scale;
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(place < side - 1 ? place : side - 1));
  }
};

/// All bits set if this bit is.
std::uint32_t mask_of(std::uint32_t value, unsigned bit) { return 0U - (value >> bit & 1U); }

/// Replaces the coordinates of cells with the transposed index of their place on the curve. [Skilling 2004]
void transpose(Cells& cells) {
  auto& [x, y, z] = cells.axes;
  for (unsigned bit = bits - 1; bit > 0; --bit) {
    const std::uint32_t lower = (1U << bit) - 1;
    for (std::size_t k = 0; k < Cells::capacity; ++k) {
      std::uint32_t a = x[k], b = y[k], c = z[k];
      a ^= lower & mask_of(a, bit);
      const std::uint32_t flip_b = mask_of(b, bit), swap_b = (a ^ b) & lower & ~flip_b;
      a ^= (lower & flip_b) ^ swap_b;
      b ^= swap_b;
      const std::uint32_t flip_c = mask_of(c, bit), swap_c = (a ^ c) & lower & ~flip_c;
      x[k] = a ^ (lower & flip_c) ^ swap_c;
      y[k] = b;
      z[k] = c ^ swap_c;
    }
  }
  for (std::size_t k = 0; k < Cells::capacity; ++k) {
    y[k] ^= x[k];
    z[k] ^= y[k];
    std::uint32_t parity = z[k] >> 1;  // each bit becomes the parity of the higher ones
    for (unsigned shift = 1; shift < bits; shift *= 2) parity ^= parity >> shift;
    for (auto& axis : cells.axes) axis[k] ^= parity;
  }
}

/// Two zeros after each of ten bits.
std::uint32_t spread_bits(std::uint32_t value) {
  value = (value | value << 16) & 0x030000FFU;
  value = (value | value << 8) & 0x0300F00FU;
  value = (value | value << 4) & 0x030C30C3U;
  return (value | value << 2) & 0x09249249U;
}

std::vector<Entry> entries_of(std::span<const NumberedPoint> points) {
  const CellScale scale(points);
  std::vector<Entry> entries(points.size());
  Cells cells;
  for (std::size_t begin = 0; begin < points.size(); begin += Cells::capacity) {
    const std::size_t count = std::min(Cells::capacity, points.size() - begin);
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) cells.axes[axis][k] = scale.cell(points[begin + k], axis);
    transpose(cells);
    const auto& [x, y, z] = cells.axes;
    for (std::size_t k = 0; k < count; ++k)
      entries[begin + k] = {spread_bits(x[k]) << 2 | spread_bits(y[k]) << 1 | spread_bits(z[k]),
                            static_cast<std::uint32_t>(begin + k)};
  }
  return entries;
}

/// Sorts by place; ties keep their order. A digit at a time, the lowest first.
void sort_by_place(std::vector<Entry>& entries) {
  std::array<std::array<std::uint32_t, side>, 3> starts{};
  for (const Entry& entry : entries)
    for (std::size_t digit = 0; digit < 3; ++digit) ++starts[digit][entry.place >> digit * bits & (side - 1)];
  std::vector<Entry> sorted(entries.size());
  for (std::size_t digit = 0; digit < 3; ++digit) {
    std::uint32_t sum = 0;
    for (std::uint32_t& start : starts[digit]) sum += std::exchange(start, sum);
    for (const Entry& entry : entries) sorted[starts[digit][entry.place >> digit * bits & (side - 1)]++] = entry;
    std::swap(entries, sorted);
  }
}

}  // namespace

void sort_along_curve(std::span<NumberedPoint> points) {
  constexpr std::size_t few = 64;
  if (points.size() < 2) return;
  std::vector<Entry> entries = entries_of(points);
  sort_by_place(entries);
  const std::vector<NumberedPoint> before(points.begin(), points.end());
  for (std::size_t k = 0; k < points.size(); ++k) points[k] = before[entries[k].point];
  if (entries.front().place == entries.back().place) return;
  // A cell that holds many points is a small part of the cube: these are sorted in a cube of their own.
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    while (end < points.size() && entries[end].place == entries[begin].place) ++end;
    if (end - begin > few) sort_along_curve(points.subspan(begin, end - begin));
  }
}

}  // namespace stiv
