// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/filters/box_filter.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/filters/box_filter.cpp"
#include "vector/foreach_target.hpp"

#include "detection/filters/pair_step-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// Along one axis, of which `x` are the coordinates.
template <EventKind kind>
HWY_INLINE Lanes gap_along(Lanes Point::*x, const PairStep& step) {
  const Gaps first = gaps_between<kind>(step.start[0].*x, step.start[1].*x, step.start[2].*x);
  const Gaps last = gaps_between<kind>(step.end[0].*x, step.end[1].*x, step.end[2].*x);
  return least_gap(first, last);
}

template <EventKind kind>
HWY_INLINE Mask boxes_apart(const PairStep& step, double separation) {
  const Lanes gap =
      max3(gap_along<kind>(&Point::x, step), gap_along<kind>(&Point::y, step), gap_along<kind>(&Point::z, step));
  return hn::Gt(gap, all(separation));
}

void find_boxes_apart(EventKind kind, const PairBlock& pairs, const VertexStep* vertices, double separation,
                      unsigned char* result) {
  if (kind == EventKind::vertex_face)
    flag_pairs<boxes_apart<EventKind::vertex_face>>(pairs, vertices, separation, result);
  else
    flag_pairs<boxes_apart<EventKind::edge_edge>>(pairs, vertices, separation, result);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void find_boxes_apart(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                      PairFlags& apart) {
  STIV_FOR_VECTOR_TARGET(find_boxes_apart)(kind, pairs, vertices.data(), separation, apart.data());
}

}  // namespace stiv
#endif
