// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/common_boxes.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/broad_phase/common_boxes.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "vector/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Coordinates = hn::CappedTag<double, 4>;  // x, y, z, 0, or as many of them as there are lanes
using Numbers = hn::Rebind<float, Coordinates>;
using Units = hn::Rebind<std::int32_t, Coordinates>;
using Point = hn::Vec<Coordinates>;

constexpr std::size_t lane_count = hn::MaxLanes(Coordinates());
constexpr std::size_t parts = 4 / lane_count;

HWY_INLINE Point part_of(const double* point, std::size_t part) {
  return hn::LoadU(Coordinates(), point + part * lane_count);
}

/// As the function of this name for SweptVertices.
HWY_INLINE hn::Vec<Numbers> round_down(Point value) {
  using Limits = std::numeric_limits<float>;
  const Coordinates d;
  const Numbers f;
  const Point largest = hn::Set(d, static_cast<double>(Limits::max()));
  const auto nearest = hn::DemoteTo(f, hn::Min(hn::Max(value, hn::Neg(largest)), largest));
  const auto error =
      hn::Add(hn::Mul(hn::Abs(nearest), hn::Set(f, Limits::epsilon())), hn::Set(f, Limits::denorm_min()));
  return hn::Max(hn::Sub(nearest, error), hn::Set(f, Limits::lowest()));
}

/// The nearest integers: those of the last bits of the sums.
HWY_INLINE hn::Vec<Units> in_units(Point lengths, double to_units) {
  const Coordinates d;
  const Point sum = hn::Add(hn::Mul(lengths, hn::Set(d, to_units)), hn::Set(d, 0x1.8p52));
  const hn::Rebind<std::uint64_t, Coordinates> bits;
  const hn::Rebind<std::uint32_t, Coordinates> low;
  return hn::BitCast(Units(), hn::TruncateTo(low, hn::BitCast(bits, sum)));
}

/// Raises `reach` to that of the coarse step.
HWY_INLINE void make_box(const CommonFrame& frame, const VertexStep& step, PackedBox& box, CoarseStep& coarse,
                         hn::Vec<Units>& reach) {
  const Coordinates d;
  const Numbers f;
  Point start[parts], end[parts], length = hn::Zero(d);
  bool rests = true;
  for (std::size_t part = 0; part < parts; ++part) {
    const Point from = part_of(step.start, part), to = part_of(step.end, part), centre = part_of(frame.centre, part);
    start[part] = hn::Sub(from, centre);
    end[part] = hn::Sub(hn::Sub(to, centre), part_of(frame.motion, part));
    length = hn::Max(length, hn::Abs(hn::Sub(end[part], start[part])));
    rests &= hn::AllTrue(d, hn::Eq(from, to));
    const auto first = in_units(start[part], frame.to_units);
    const auto last = in_units(hn::Sub(to, part_of(frame.end_centre, part)), frame.to_units);
    hn::StoreU(first, Units(), coarse.start + part * lane_count);
    hn::StoreU(last, Units(), coarse.end + part * lane_count);
    reach = hn::Max(reach, hn::Abs(hn::Sub(last, first)));
  }
  const Point padding = hn::Add(hn::Set(d, frame.margin), hn::Mul(hn::Set(d, frame.slack), hn::MaxOfLanes(d, length)));
  float* const numbers = box.values.data();
  for (std::size_t part = 0; part < parts; ++part)
    hn::StoreU(round_down(hn::Sub(hn::Min(start[part], end[part]), padding)), f, numbers + part * lane_count);
  for (std::size_t part = 0; part < parts; ++part)
    hn::StoreU(round_down(hn::Sub(hn::Neg(hn::Max(start[part], end[part])), padding)), f,
               numbers + 3 + part * lane_count);
  numbers[6] = rests ? 1.0F : -1.0F;
  numbers[7] = 0;
}

std::int32_t make_all_boxes(const CommonFrame& frame, const VertexStep* steps, std::span<const Index> vertices,
                            PackedBox* boxes, CoarseStep* coarse) {
  const Units i;
  auto reach = hn::Zero(i);
  for (const Index vertex : vertices) make_box(frame, steps[vertex], boxes[vertex], coarse[vertex], reach);
  return hn::GetLane(hn::MaxOfLanes(i, reach));
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

std::int32_t make_common_boxes(const CommonFrame& frame, const VertexStep* steps, std::span<const Index> vertices,
                               PackedBox* boxes, CoarseStep* coarse) {
  return STIV_FOR_VECTOR_TARGET(make_all_boxes)(frame, steps, vertices, boxes, coarse);
}

}  // namespace stiv
#endif
