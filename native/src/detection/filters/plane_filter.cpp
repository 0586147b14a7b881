// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/filters/plane_filter.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/filters/plane_filter.cpp"
#include "vector/foreach_target.hpp"

#include "detection/filters/pair_directions-inl.hpp"
#include "detection/filters/pair_step-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// The normal's length is bounded by the sum of its components.
template <EventKind kind>
HWY_INLINE Mask plane_separates(Point normal, const PairStep& step, Lanes clearance) {
  return keeps_apart<kind>(normal, step, hn::Mul(clearance, sum_norm(normal)));
}

template <EventKind kind>
HWY_INLINE Mask apart(const PairStep& step, double separation) {
  const Lanes clearance = hn::Add(all(separation), rounding_of(step));
  const Mask at_start = plane_separates<kind>(normal_of<kind>(step.start), step, clearance);
  constexpr bool few_lanes = HWY_MAX_BYTES <= 2 * sizeof(double);  // of many, some always need another plane
  if (few_lanes && hn::AllTrue(Doubles(), at_start)) return at_start;
  const Point middles = between_middles<kind>(step.start);
  const Mask between = hn::Or(at_start, plane_separates<kind>(middles, step, clearance));
  if (hn::AllTrue(Doubles(), between)) return between;
  const Mask apart = hn::Or(between, plane_separates<kind>(normal_of<kind>(step.end), step, clearance));
  if constexpr (kind == EventKind::vertex_face) return apart;
  return hn::Or(apart, plane_separates<kind>(across(step.start[0], middles), step, clearance));
}

void find_apart(EventKind kind, const PairBlock& pairs, const VertexStep* vertices, double separation,
                unsigned char* result) {
  if (kind == EventKind::vertex_face)
    flag_pairs<apart<EventKind::vertex_face>>(pairs, vertices, separation, result);
  else
    flag_pairs<apart<EventKind::edge_edge>>(pairs, vertices, separation, result);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void find_apart(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                PairFlags& apart) {
  STIV_FOR_VECTOR_TARGET(find_apart)(kind, pairs, vertices.data(), separation, apart.data());
}

}  // namespace stiv
#endif
