// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/window_order.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/broad_phase/window_order.cpp"
#include "vector/foreach_target.hpp"

#include "vector/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Keys = hn::CappedTag<std::int32_t, 8>;
/// Distinct numbers that sort as the points do along the longest axis: the distance from the first of them, then the
/// index. Halves, because a difference may overflow.
HWY_INLINE void find_keys(const NumberedPoint* points, std::size_t count, std::int32_t* keys) {
  float low[3], extent[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float high = low[axis] = points[0].position[axis];
    for (std::size_t k = 1; k < count; ++k) {
      const float value = points[k].position[axis];
      low[axis] = value < low[axis] ? value : low[axis];
      high = value > high ? value : high;
    }
    low[axis] /= 2;
    extent[axis] = high / 2 - low[axis];
  }
  std::size_t axis = extent[1] > extent[0] ? 1 : 0;
  if (extent[2] > extent[axis]) axis = 2;
  constexpr float most = 0x1p24F;
  const float scale = most / extent[axis];
  for (std::size_t k = 0; k < count; ++k) {
    const float place = (points[k].position[axis] / 2 - low[axis]) * scale;
    const auto number = static_cast<std::int32_t>(place < most ? place : most);
    keys[k] = number * static_cast<std::int32_t>(window_capacity) + static_cast<std::int32_t>(k);
  }
}

HWY_INLINE void sort_along_longest_axis(NumberedPoint* points, std::size_t count) {
  const Keys d;
  HWY_ALIGN std::int32_t keys[window_capacity] = {};
  HWY_ALIGN std::int32_t ranks[window_capacity];
  find_keys(points, count, keys);
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const auto own = hn::Load(d, keys + k);
    auto less = hn::Zero(d);  // minus their number
    for (std::size_t other = 0; other < count; ++other)
      less = hn::Add(less, hn::VecFromMask(d, hn::Lt(hn::Set(d, keys[other]), own)));
    hn::Store(hn::Neg(less), d, ranks + k);
  }
  NumberedPoint sorted[window_capacity];
  for (std::size_t k = 0; k < count; ++k) sorted[ranks[k]] = points[k];
  for (std::size_t k = 0; k < count; ++k) points[k] = sorted[k];
}

void order_window(NumberedPoint* points, std::size_t count, std::size_t run) {
  if (count <= run) return;
  sort_along_longest_axis(points, count);
  const std::size_t first = size_of_first_part(count, run);
  order_window(points, first, run);
  order_window(points + first, count - first, run);
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
