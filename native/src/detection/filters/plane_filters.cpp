// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/filters/pair_filters.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/filters/plane_filters.cpp"
#include "vector/foreach_target.hpp"

#include "detection/filters/pair_directions-inl.hpp"
#include "detection/filters/pair_step-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// Along one axis; `x` are the coordinates along it.
template <EventKind kind>
HWY_INLINE Lanes gap_along(Lanes Point::*x, const PairStep& step) {
  const Gaps first = gaps_between<kind>(step.start[0].*x, step.start[1].*x, step.start[2].*x);
  const Gaps last = gaps_between<kind>(step.end[0].*x, step.end[1].*x, step.end[2].*x);
  return least_gap(first, last);
}

template <EventKind kind>
HWY_INLINE Mask are_boxes_apart(const PairStep& step, double separation) {
  const Lanes gap =
      max3(gap_along<kind>(&Point::x, step), gap_along<kind>(&Point::y, step), gap_along<kind>(&Point::z, step));
  return hn::Gt(gap, all(separation));
}

void find_apart_by_boxes(EventKind kind, const PairBlock& pairs, const VertexStep* vertices, double separation,
                         unsigned char* result) {
  if (kind == EventKind::vertex_face)
    flag_pairs<are_boxes_apart<EventKind::vertex_face>>(pairs, vertices, separation, result);
  else
    flag_pairs<are_boxes_apart<EventKind::edge_edge>>(pairs, vertices, separation, result);
}

/// The normal's length is bounded by the sum of its components.
template <EventKind kind>
HWY_INLINE Mask plane_separates(Point normal, const PairStep& step, Lanes clearance) {
  return keeps_apart<kind>(normal, step, hn::Mul(clearance, sum_norm(normal)));
}

template <EventKind kind>
HWY_INLINE Mask apart(const PairStep& step, double separation) {
  const Lanes clearance = hn::Add(all(separation), rounding_of(step));
  const Mask at_start = plane_separates<kind>(normal_of<kind>(step.start), step, clearance);
  constexpr bool few_lanes =
      HWY_MAX_BYTES <= 2 * sizeof(double);  // with many lanes, some pair always needs another plane
  if (few_lanes && hn::AllTrue(Doubles(), at_start)) return at_start;
  const Point middles = between_middles<kind>(step.start);
  const Mask between = hn::Or(at_start, plane_separates<kind>(middles, step, clearance));
  if (hn::AllTrue(Doubles(), between)) return between;
  const Mask apart = hn::Or(between, plane_separates<kind>(normal_of<kind>(step.end), step, clearance));
  if constexpr (kind == EventKind::vertex_face) return apart;
  return hn::Or(apart, plane_separates<kind>(across(step.start[0], middles), step, clearance));
}

void find_apart_by_planes(EventKind kind, const PairBlock& pairs, const VertexStep* vertices, double separation,
                          unsigned char* result) {
  if (kind == EventKind::vertex_face)
    flag_pairs<apart<EventKind::vertex_face>>(pairs, vertices, separation, result);
  else
    flag_pairs<apart<EventKind::edge_edge>>(pairs, vertices, separation, result);
}

/// From a point to the closest point of a segment; to its first end if it has zero length.
HWY_INLINE Point to_segment(Point from, Point a, Point b) {
  const Lanes zero = hn::Zero(Doubles());
  const Point along = b - a, first = a - from;
  const Lanes length2 = dot(along, along);
  const Lanes part = hn::IfThenElseZero(hn::Gt(length2, zero), hn::Div(hn::Neg(dot(first, along)), length2));
  return first + hn::Min(hn::Max(part, zero), all(1)) * along;
}

HWY_INLINE Point shorter(Point a, Point b) {
  const Mask first = hn::Le(dot(a, a), dot(b, b));
  return {hn::IfThenElse(first, a.x, b.x), hn::IfThenElse(first, a.y, b.y), hn::IfThenElse(first, a.z, b.z)};
}

/// Between the closest points of both sides, up to sign, if one lies on the boundary of its side.
template <EventKind kind>
HWY_INLINE Point between_closest_boundary_points(const Point* x) {
  const Lanes zero = hn::Zero(Doubles());
  const Point origin{zero, zero, zero};
  if constexpr (kind == EventKind::vertex_face)
    return shorter(to_segment(origin, x[0], x[1]),
                   shorter(to_segment(origin, x[1], x[2]), to_segment(origin, x[2], x[0])));
  return shorter(shorter(to_segment(origin, x[1], x[2]), to_segment(x[0], x[1], x[2])),
                 shorter(to_segment(x[1], origin, x[0]), to_segment(x[2], origin, x[0])));
}

/// With the length of the normal, not the sum of its components: many pairs lie just beyond the separation. The gap is
/// at most the length's square, a difference of points of both sides: where that vanishes, nothing is apart.
template <EventKind kind>
HWY_INLINE Mask are_apart_along_closest_points(const PairStep& step, double separation) {
  const Point normal = between_closest_boundary_points<kind>(step.start);
  const Lanes length = hn::Mul(all(1 + 0x1p-48), hn::Sqrt(dot(normal, normal)));
  const Lanes rounding = hn::Mul(all(16), rounding_of(step));  // more than the tolerance of an advancement
  return keeps_apart<kind>(normal, step,
                           hn::Add(hn::Mul(all(separation), length), hn::Mul(rounding, sum_norm(normal))));
}

void find_apart_by_closest_points(EventKind kind, const PairBlock& pairs, const VertexStep* vertices, double separation,
                                  unsigned char* result) {
  if (kind == EventKind::vertex_face)
    flag_pairs<are_apart_along_closest_points<EventKind::vertex_face>>(pairs, vertices, separation, result);
  else
    flag_pairs<are_apart_along_closest_points<EventKind::edge_edge>>(pairs, vertices, separation, result);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void find_apart_by_boxes(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                         PairFlags& apart) {
  STIV_FOR_VECTOR_TARGET(find_apart_by_boxes)(kind, pairs, vertices.data(), separation, apart.data());
}

void find_apart_by_planes(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                          PairFlags& apart) {
  STIV_FOR_VECTOR_TARGET(find_apart_by_planes)(kind, pairs, vertices.data(), separation, apart.data());
}

void find_apart_by_closest_points(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices,
                                  double separation, PairFlags& apart) {
  STIV_FOR_VECTOR_TARGET(find_apart_by_closest_points)(kind, pairs, vertices.data(), separation, apart.data());
}

}  // namespace stiv
#endif
