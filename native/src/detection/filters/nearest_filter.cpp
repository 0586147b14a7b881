// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/filters/nearest_filter.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/filters/nearest_filter.cpp"
#include "vector/foreach_target.hpp"

#include "detection/filters/pair_step-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// From a point to the nearest one of a segment; to its first end where it has no length.
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

/// Between the nearest points of both sides, or the opposite, where one lies on the rim of its side.
template <EventKind kind>
HWY_INLINE Point between_rims(const Point* x) {
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
HWY_INLINE Mask rims_apart(const PairStep& step, double separation) {
  const Point normal = between_rims<kind>(step.start);
  const Lanes length = hn::Mul(all(1 + 0x1p-48), hn::Sqrt(dot(normal, normal)));
  const Lanes rounding = hn::Mul(all(16), rounding_of(step));  // more than what an advance ends within
  return keeps_apart<kind>(normal, step,
                           hn::Add(hn::Mul(all(separation), length), hn::Mul(rounding, sum_norm(normal))));
}

void find_rims_apart(EventKind kind, const PairBlock& pairs, const VertexStep* vertices, double separation,
                     unsigned char* result) {
  if (kind == EventKind::vertex_face)
    flag_pairs<rims_apart<EventKind::vertex_face>>(pairs, vertices, separation, result);
  else
    flag_pairs<rims_apart<EventKind::edge_edge>>(pairs, vertices, separation, result);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void find_rims_apart(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                     PairFlags& apart) {
  STIV_FOR_VECTOR_TARGET(find_rims_apart)(kind, pairs, vertices.data(), separation, apart.data());
}

}  // namespace stiv
#endif
