// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/filters/pair_filters.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/filters/hull_filter.cpp"
#include "vector/foreach_target.hpp"

#include "detection/filters/pair_directions-inl.hpp"
#include "detection/filters/pair_step-inl.hpp"
#include "hwy/cache_control.h"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// One pair in each lane, relative to the start of its first vertex.
struct PairHulls {
  Point start[4], end[4];
};

HWY_INLINE PairHulls load_hulls(const PairView& pairs, std::size_t first, const VertexStep* vertices, Point motion) {
  const TwoPoints origin = load_vertices(vertices, pairs.vertices[0] + first);
  const Point far_origin = origin.first + motion;
  PairHulls hulls;
  hulls.start[0] = {all(0), all(0), all(0)};
  hulls.end[0] = origin.second - far_origin;
  for (std::size_t k = 1; k < 4; ++k) {
    const TwoPoints vertex = load_vertices(vertices, pairs.vertices[k] + first);
    hulls.start[k] = vertex.first - origin.first;
    hulls.end[k] = vertex.second - far_origin;
  }
  return hulls;
}

/// The range of a vertex along a direction.
struct Span {
  Lanes low, high;
};

HWY_INLINE Span span_of(Point normal, const PairHulls& hulls, std::size_t k) {
  const Lanes start = dot(normal, hulls.start[k]), end = dot(normal, hulls.end[k]);
  return {hn::Min(start, end), hn::Max(start, end)};
}

HWY_INLINE Span both(Span a, Span b) { return {hn::Min(a.low, b.low), hn::Max(a.high, b.high)}; }

HWY_INLINE Lanes largest_component(Point a) { return max3(hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)); }

/// The gap between the sides' spans along a direction, whichever comes first.
template <EventKind kind>
HWY_INLINE Lanes gap(Point normal, const PairHulls& hulls) {
  const Span v0 = span_of(normal, hulls, 0), v1 = span_of(normal, hulls, 1);
  const Span v2 = span_of(normal, hulls, 2), v3 = span_of(normal, hulls, 3);
  const Span first = kind == EventKind::vertex_face ? v0 : both(v0, v1);
  const Span second = kind == EventKind::vertex_face ? both(v1, both(v2, v3)) : both(v2, v3);
  return hn::Max(hn::Sub(first.low, second.high), hn::Sub(second.low, first.high));
}

template <EventKind kind>
HWY_INLINE Mask separates(Point normal, const PairHulls& hulls, Lanes clearance) {
  constexpr double underflow = 0x1p-970;
  return hn::Gt(gap<kind>(normal, hulls), hn::Add(hn::Mul(clearance, sum_norm(normal)), all(underflow)));
}

/// Its bound of rounding is by default eight times that of the plane filter. It covers the motion of the frame and the
/// larger coordinates of other steps. So it drops only pairs that the plane filter would drop too.
template <EventKind kind>
HWY_INLINE Mask are_hulls_apart(const PairHulls& hulls, const NearbySteps& steps) {
  Lanes reach = all(0), magnitude = all(0);
  for (std::size_t k = 0; k < 4; ++k) {
    reach = hn::Max(reach, largest_component(hulls.end[k] - hulls.start[k]));
    magnitude = hn::Max(magnitude, hn::Max(sum_norm(hulls.end[k]), sum_norm(hulls.start[k])));
  }
  const Lanes clearance = hn::Add(hn::Add(all(steps.separation), hn::Mul(all(2 * steps.slack), reach)),
                                  hn::Mul(all(steps.rounding), magnitude));
  const Point* const x = hulls.start + 1;
  const Mask by_normal = separates<kind>(normal_of<kind>(x), hulls, clearance);
  if (hn::AllTrue(Doubles(), by_normal)) return by_normal;
  const Point middles = between_middles<kind>(x);
  const Mask apart = hn::Or(by_normal, separates<kind>(middles, hulls, clearance));
  if constexpr (kind == EventKind::vertex_face) return apart;
  if (hn::AllTrue(Doubles(), apart)) return apart;
  return hn::Or(apart, separates<kind>(across(x[0], middles), hulls, clearance));
}

/// Fetches what load_hulls will load. Too few loads are under way while the hulls of other pairs are compared.
HWY_INLINE void prefetch_hulls(const PairView& pairs, std::size_t first, const VertexStep* vertices) {
  if (first >= pairs.count) return;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t lane = 0; lane < hn::Lanes(Doubles()); ++lane)
      hwy::Prefetch(vertices + pairs.vertices[k][first + lane]);
}

template <EventKind kind>
void find_apart_by_hulls_of_kind(const PairView& pairs, const VertexStep* vertices, const NearbySteps& steps,
                                 unsigned char* result) {
  const Doubles d;
  const double* const m = steps.motion.data();
  const Point motion{all(m[0]), all(m[1]), all(m[2])};
  HWY_ALIGN double flags[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t first = 0; first < pairs.count; first += hn::Lanes(d)) {
    prefetch_hulls(pairs, first + 2 * hn::Lanes(d), vertices);
    const Mask mask = are_hulls_apart<kind>(load_hulls(pairs, first, vertices, motion), steps);
    hn::Store(hn::IfThenElseZero(mask, all(1)), d, flags);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) result[first + lane] = flags[lane] != 0;
  }
}

void find_apart_by_hulls(EventKind kind, const PairView& pairs, const VertexStep* vertices, const NearbySteps& steps,
                         unsigned char* result) {
  if (kind == EventKind::vertex_face)
    find_apart_by_hulls_of_kind<EventKind::vertex_face>(pairs, vertices, steps, result);
  else
    find_apart_by_hulls_of_kind<EventKind::edge_edge>(pairs, vertices, steps, result);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void find_apart_by_hulls(EventKind kind, const PairView& pairs, const VertexSteps& vertices, const NearbySteps& steps,
                         PairFlags& apart) {
  STIV_FOR_VECTOR_TARGET(find_apart_by_hulls)(kind, pairs, vertices.data(), steps, apart.data());
}

}  // namespace stiv
#endif
