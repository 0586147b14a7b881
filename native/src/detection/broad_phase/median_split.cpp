// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/median_split.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace stiv {

namespace {

using Key = std::uint64_t;

/// Sorts by position along an axis, then by number. [The bits of a float, with all of them inverted if it is negative
/// and its sign inverted otherwise, sort as it does.]
template <std::size_t axis>
Key key_of(const NumberedPoint& point) {
  const auto bits = std::bit_cast<std::uint32_t>(point.position[axis]);
  const std::uint32_t inverted = (0U - (bits >> 31)) | 0x80000000U;
  return static_cast<Key>(bits ^ inverted) << 32 | static_cast<std::uint32_t>(point.number);
}

/// A whole point in one register; the bits of its number are only copied.
using Four = Eigen::Array4f;
Four load(const NumberedPoint& point) {
  Four four;
  std::memcpy(four.data(), &point, sizeof(point));
  return four;
}
void store(const Four& four, NumberedPoint& point) { std::memcpy(&point, four.data(), sizeof(point)); }

std::size_t longest_axis(std::span<const NumberedPoint> points) {
  Four low = load(points[0]), high = low;
  for (const NumberedPoint& point : points) {
    low = low.min(load(point));
    high = high.max(load(point));
  }
  Index longest = 0;
  (high - low).head<3>().maxCoeff(&longest);
  return static_cast<std::size_t>(longest);
}

/// A key with about `rank` of the points before it: from a sample, shifted from `rank` toward the middle, so that the
/// smaller side likely remains.
template <std::size_t axis>
Key pivot(std::span<const NumberedPoint> points, std::size_t rank) {
  constexpr std::size_t most = 31;
  std::array<Key, most> keys;
  const std::size_t count = points.size() < 512 ? 5 : most, aside = count / 8;
  for (std::size_t k = 0; k < count; ++k) keys[k] = key_of<axis>(points[(2 * k + 1) * points.size() / (2 * count)]);
  std::sort(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(count));
  const std::size_t place = rank * count / points.size();
  return keys[2 * place < count ? std::min(place + aside, count / 2) : std::max(place - aside, count / 2)];
}

/// Moves those before the pivot to the front and returns their number. No branches: a mispredicted branch costs more
/// than an exchange, provided that each point is written and read in one piece.
template <std::size_t axis>
std::size_t partition(std::span<NumberedPoint> points, Key pivot) {
  std::size_t before = 0;
  for (NumberedPoint& point : points) {
    const bool counts = key_of<axis>(point) < pivot;
    const Four moved = load(point);
    store(load(points[before]), point);
    store(moved, points[before]);
    before += counts;
  }
  return before;
}

/// Quickselect [Hoare 1961], with pivots from a sample [Floyd and Rivest 1975]. After 24 passes it calls the standard
/// library, which is linear for any order.
template <std::size_t axis>
void select(std::span<NumberedPoint> points, std::size_t rank) {
  constexpr std::size_t few = 16;
  for (int pass = 0; pass < 24 && points.size() > few; ++pass) {
    const std::size_t before = partition<axis>(points, pivot<axis>(points, rank));
    if (before == rank) return;
    if (before > rank) {
      points = points.first(before);
    } else {
      points = points.subspan(before);
      rank -= before;
    }
  }
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(rank), points.end(),
                   [](const auto& a, const auto& b) { return key_of<axis>(a) < key_of<axis>(b); });
}

}  // namespace

void split_at_median(std::span<NumberedPoint> points, std::size_t half) {
  constexpr std::array along{select<0>, select<1>, select<2>};
  along[longest_axis(points)](points, half);
}

}  // namespace stiv
