// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/window_order.hpp"

#include <cstdint>
#include <limits>

#ifndef STIV_WINDOW_ORDER_TYPES
#define STIV_WINDOW_ORDER_TYPES

namespace stiv {

/// Up to this many points are sorted by comparing all pairs: without branches, that is faster than any other way.
constexpr std::size_t few_points = 32;
/// Keys are read by this many; the last ones are padded with keys above all others.
constexpr std::size_t keys_at_once = 16;

/// Work space for one window.
struct WindowBuffers {
  alignas(64) std::int32_t keys[window_capacity + keys_at_once];
  alignas(64) float positions[window_capacity + keys_at_once];
  alignas(64) std::int32_t ranks[few_points];
  NumberedPoint points[window_capacity];
};

/// The longest axis of a box: a quarter of its least coordinate and of its length.
struct LongestAxis {
  std::size_t axis;
  float low, extent;
};

}  // namespace stiv

#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/broad_phase/window_order.cpp"
#include "vector/foreach_target.hpp"

#include "vector/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Keys = hn::CappedTag<std::int32_t, 8>;
using Floats = hn::CappedTag<float, 8>;
using Four = hn::CappedTag<float, 4>;

/// Above all keys but those for padding.
constexpr std::int32_t key_end = ((1 << 20) + 1) * static_cast<std::int32_t>(window_capacity);

HWY_INLINE std::size_t padded(std::size_t count) { return (count + keys_at_once - 1) / keys_at_once * keys_at_once; }

/// Coordinates from `lane` on, then zeros. Not the index, which is slow as a float: it is denormal.
HWY_INLINE hn::Vec<Four> load(const NumberedPoint& point, std::size_t lane) {
  const Four d;
  return hn::IfThenElseZero(hn::Lt(hn::Iota(d, static_cast<float>(lane)), hn::Set(d, 3)),
                            hn::Load(d, point.position.data() + lane));
}

/// Quarters, because sums and differences may overflow.
HWY_INLINE LongestAxis longest_axis(const NumberedPoint* points, std::size_t count) {
  const Four d;
  constexpr std::size_t chains = 4;  // independent, because each minimum waits for the one before
  HWY_ALIGN float low[4], high[4];
  for (std::size_t lane = 0; lane < 3; lane += hn::Lanes(d)) {
    hn::Vec<Four> least[chains], most[chains];
    for (std::size_t chain = 0; chain < chains; ++chain) least[chain] = most[chain] = load(points[0], lane);
    std::size_t k = 0;
    for (; k + chains <= count; k += chains)
      for (std::size_t chain = 0; chain < chains; ++chain) {
        least[chain] = hn::Min(least[chain], load(points[k + chain], lane));
        most[chain] = hn::Max(most[chain], load(points[k + chain], lane));
      }
    for (; k < count; ++k) {
      least[0] = hn::Min(least[0], load(points[k], lane));
      most[0] = hn::Max(most[0], load(points[k], lane));
    }
    hn::Store(hn::Min(hn::Min(least[0], least[1]), hn::Min(least[2], least[3])), d, low + lane);
    hn::Store(hn::Max(hn::Max(most[0], most[1]), hn::Max(most[2], most[3])), d, high + lane);
  }
  const float extent[3] = {high[0] / 4 - low[0] / 4, high[1] / 4 - low[1] / 4, high[2] / 4 - low[2] / 4};
  std::size_t axis = extent[1] > extent[0];
  axis += static_cast<std::size_t>(extent[2] > extent[axis]) * (2 - axis);  // not a branch: it is hard to predict
  return {axis, low[axis] / 4, extent[axis]};
}

/// Distinct numbers that sort as the points do along the longest axis: the distance from the first of them, then the
/// index. [The bits of floats that are not negative sort as they do. Between the extent and twice the extent, they
/// differ by at most 2^23, nearly in proportion.]
HWY_INLINE void find_keys(const NumberedPoint* points, std::size_t count, WindowBuffers& buffers) {
  static_assert(window_capacity == 1 << 10);
  const Floats d;
  const Keys i;
  const LongestAxis along = longest_axis(points, count);
  const std::size_t end = padded(count);
  for (std::size_t k = 0; k < count; ++k) buffers.positions[k] = points[k].position[along.axis];
  for (std::size_t k = count; k < end; ++k) buffers.positions[k] = 0;
  const auto quarter = hn::Set(d, 0.25F), low = hn::Set(d, along.low), extent = hn::Set(d, along.extent);
  const auto first = hn::BitCast(i, extent);
  auto index = hn::Iota(i, 0);
  for (std::size_t k = 0; k < end; k += hn::Lanes(i)) {
    const auto distance = hn::Sub(hn::Mul(hn::Load(d, buffers.positions + k), quarter), low);
    const auto place = hn::ShiftRight<3>(hn::Sub(hn::BitCast(i, hn::Add(distance, extent)), first));
    hn::Store(hn::Add(hn::ShiftLeft<10>(place), index), i, buffers.keys + k);
    index = hn::Add(index, hn::Set(i, static_cast<std::int32_t>(hn::Lanes(i))));
  }
  for (std::size_t k = count; k < end; ++k) buffers.keys[k] = std::numeric_limits<std::int32_t>::max();
}

/// Number of keys below a bound, and the keys next to it on both sides, if there are any.
struct Cut {
  std::size_t below;
  std::int32_t last_below, first_above;
};

HWY_INLINE Cut cut_at(std::int32_t bound, const std::int32_t* keys, std::size_t count) {
  const Keys d;
  const auto limit = hn::Set(d, bound), most = hn::Set(d, std::numeric_limits<std::int32_t>::max());
  auto below = hn::Zero(d), last = below, first = most;  // `below`: minus their number
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const auto key = hn::Load(d, keys + k);
    const auto is_below = hn::Lt(key, limit);
    below = hn::Add(below, hn::VecFromMask(d, is_below));
    last = hn::Max(last, hn::IfThenElseZero(is_below, key));
    first = hn::Min(first, hn::IfThenElse(is_below, most, key));
  }
  return {static_cast<std::size_t>(-hn::GetLane(hn::SumOfLanes(d, below))), hn::GetLane(hn::MaxOfLanes(d, last)),
          hn::GetLane(hn::MinOfLanes(d, first))};
}

/// A bound with `rank` of the keys below it: by interpolation between keys, and by bisection where that gains little.
HWY_INLINE std::int32_t find_bound(const std::int32_t* keys, std::size_t count, std::size_t rank) {
  std::int32_t low = 0, high = key_end;
  std::size_t low_rank = 0, high_rank = count;
  for (bool bisect = false;;) {
    const std::size_t between = high_rank - low_rank;
    const float fraction = bisect ? 0.5F : static_cast<float>(rank - low_rank) / static_cast<float>(between);
    const auto step = static_cast<std::int32_t>(fraction * static_cast<float>(high - low));
    const std::int32_t bound = low + (step < 1 ? 1 : step < high - low ? step : high - low);
    const Cut cut = cut_at(bound, keys, padded(count));
    if (cut.below == rank) return bound;
    if (cut.below == rank + 1) return cut.last_below;
    if (cut.below < rank) {
      low = cut.first_above;
      low_rank = cut.below;
    } else {
      high = cut.last_below;
      high_rank = cut.below - 1;
    }
    bisect = high_rank - low_rank > between / 2;
  }
}

/// Those below the bound come first; both parts keep their order.
HWY_INLINE void split(const NumberedPoint* points, std::size_t count, std::size_t first, WindowBuffers& buffers,
                      NumberedPoint* result) {
  const std::int32_t bound = find_bound(buffers.keys, count, first);
  std::size_t below = 0, above = first;
  for (std::size_t k = 0; k < count; ++k) {
    const auto is_below = static_cast<std::size_t>(buffers.keys[k] < bound);
    result[above + ((below - above) & (0 - is_below))] = points[k];  // not a branch: it would be random
    below += is_below;
    above = first + k + 1 - below;
  }
}

HWY_INLINE void sort(const NumberedPoint* points, std::size_t count, WindowBuffers& buffers, NumberedPoint* result) {
  const Keys d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t k = 0; k < count; k += 2 * lanes) {
    const auto own = hn::Load(d, buffers.keys + k), next = hn::Load(d, buffers.keys + k + lanes);
    auto less = hn::Zero(d), less_than_next = less;  // minus their numbers
    for (std::size_t other = 0; other < count; ++other) {
      const auto key = hn::Set(d, buffers.keys[other]);
      less = hn::Add(less, hn::VecFromMask(d, hn::Lt(key, own)));
      less_than_next = hn::Add(less_than_next, hn::VecFromMask(d, hn::Lt(key, next)));
    }
    hn::Store(hn::Neg(less), d, buffers.ranks + k);
    hn::Store(hn::Neg(less_than_next), d, buffers.ranks + k + lanes);
  }
  for (std::size_t k = 0; k < count; ++k) result[buffers.ranks[k]] = points[k];
}

/// The result replaces the points, or lies in `other`. Each split moves all points from one array to the other.
void order(NumberedPoint* points, NumberedPoint* other, std::size_t count, std::size_t run, bool in_other,
           WindowBuffers& buffers) {
  if (count <= run) {
    for (std::size_t k = 0; in_other && k < count; ++k) other[k] = points[k];
    return;
  }
  const std::size_t first = size_of_first_part(count, run);
  find_keys(points, count, buffers);
  if (count <= few_points)
    sort(points, count, buffers, other);
  else
    split(points, count, first, buffers, other);
  order(other, points, first, run, !in_other, buffers);
  order(other + first, points + first, count - first, run, !in_other, buffers);
}

void order_window(NumberedPoint* points, std::size_t count, std::size_t run) {
  WindowBuffers buffers;
  order(points, buffers.points, count, run, false, buffers);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void order_window(std::span<NumberedPoint> points, std::size_t run) {
  STIV_FOR_VECTOR_TARGET(order_window)(points.data(), points.size(), run);
}

}  // namespace stiv
#endif
