// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/plane_filter.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/plane_filter.cpp"
#include "vector/foreach_target.hpp"

#include "detection/pair_directions-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// A pair a lane, seen from its first vertex: the others at the start and at the end of the step.
struct PairStep {
  Point start[3], end[3];
};

HWY_INLINE TwoPoints load_vertices(const VertexStep* vertices, const Index* indices) {
  const double* rows[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t lane = 0; lane < hn::Lanes(Doubles()); ++lane) rows[lane] = vertices[indices[lane]].start;
  return load_rows(rows);
}

HWY_INLINE PairStep load(const PairBlock& pairs, std::size_t first, const VertexStep* vertices) {
  const TwoPoints origin = load_vertices(vertices, pairs.vertices[0].data() + first);
  PairStep step;
  for (std::size_t k = 0; k < 3; ++k) {
    const TwoPoints vertex = load_vertices(vertices, pairs.vertices[k + 1].data() + first);
    step.start[k] = vertex.first - origin.first;
    step.end[k] = vertex.second - origin.second;
  }
  return step;
}

/// How far the first side lies beyond the second along n, or the second beyond the first: the first vertex projects to
/// zero. A step is linear, so the lesser of the values at both ends holds in between.
struct Gaps {
  Lanes beyond, before;
};

template <EventKind kind>
HWY_INLINE Gaps gaps(Point normal, const Point* x) {
  const Lanes p1 = dot(normal, x[0]), p2 = dot(normal, x[1]), p3 = dot(normal, x[2]);
  if constexpr (kind == EventKind::vertex_face) return {hn::Neg(max3(p1, p2, p3)), min3(p1, p2, p3)};
  const Lanes zero = hn::Zero(Doubles());
  return {hn::Sub(hn::Min(zero, p1), hn::Max(p2, p3)), hn::Sub(hn::Min(p2, p3), hn::Max(zero, p1))};
}

/// The bound of rounding is that of RelativeMotion, with the normal's length bounded by the sum of its components. The
/// comparison is strict and allows for underflow, so that a normal that vanishes separates nothing.
template <EventKind kind>
HWY_INLINE Mask plane_separates(Point normal, const PairStep& step, Lanes clearance) {
  constexpr double underflow = 0x1p-970;  // the least normal number over 2^-52
  const Gaps first = gaps<kind>(normal, step.start), last = gaps<kind>(normal, step.end);
  const Lanes gap = hn::Max(hn::Min(first.beyond, last.beyond), hn::Min(first.before, last.before));
  return hn::Gt(gap, hn::Add(hn::Mul(clearance, sum_norm(normal)), all(underflow)));
}

HWY_INLINE Lanes magnitude_of(const Point* x) { return max3(sum_norm(x[0]), sum_norm(x[1]), sum_norm(x[2])); }

template <EventKind kind>
HWY_INLINE Mask apart(const PairStep& step, double separation) {
  const Lanes magnitude = hn::Max(magnitude_of(step.start), magnitude_of(step.end));
  const Lanes clearance = hn::Add(all(separation), hn::Mul(all(0x1p-46), magnitude));
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

template <EventKind kind>
void find_apart_of_kind(const PairBlock& pairs, const VertexStep* vertices, double separation, unsigned char* result) {
  const Doubles d;
  const std::size_t width = hn::Lanes(d);
  static_assert(PairBlock::capacity % HWY_MAX_BYTES == 0);
  HWY_ALIGN double flags[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t first = 0; first < pairs.count; first += width) {
    const Mask mask = apart<kind>(load(pairs, first, vertices), separation);
    hn::Store(hn::IfThenElseZero(mask, all(1)), d, flags);
    for (std::size_t lane = 0; lane < width; ++lane) result[first + lane] = flags[lane] != 0;
  }
}

void find_apart(EventKind kind, const PairBlock& pairs, const VertexStep* vertices, double separation,
                unsigned char* result) {
  if (kind == EventKind::vertex_face)
    find_apart_of_kind<EventKind::vertex_face>(pairs, vertices, separation, result);
  else
    find_apart_of_kind<EventKind::edge_edge>(pairs, vertices, separation, result);
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
