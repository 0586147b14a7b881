// SPDX-License-Identifier: GPL-3.0-or-later

// The step of one pair in each lane, and planes between its sides. Included once for each target; see
// vector/foreach_target.hpp.
#if defined(STIV_PAIR_STEP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STIV_PAIR_STEP_INL
#undef STIV_PAIR_STEP_INL
#else
#define STIV_PAIR_STEP_INL
#endif

#include "detection/filters/pair_filters.hpp"
#include "vector/points-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// One pair in each lane: positions relative to the first vertex, at the start and at the end of the step.
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

/// The gaps from the projections of the other vertices.
template <EventKind kind>
HWY_INLINE Gaps gaps_between(Lanes p1, Lanes p2, Lanes p3) {
  if constexpr (kind == EventKind::vertex_face) return {hn::Neg(max3(p1, p2, p3)), min3(p1, p2, p3)};
  const Lanes zero = hn::Zero(Doubles());
  return {hn::Sub(hn::Min(zero, p1), hn::Max(p2, p3)), hn::Sub(hn::Min(p2, p3), hn::Max(zero, p1))};
}

template <EventKind kind>
HWY_INLINE Gaps gaps(Point normal, const Point* x) {
  return gaps_between<kind>(dot(normal, x[0]), dot(normal, x[1]), dot(normal, x[2]));
}

/// On either side, for the whole step.
HWY_INLINE Lanes least_gap(Gaps first, Gaps last) {
  return hn::Max(hn::Min(first.beyond, last.beyond), hn::Min(first.before, last.before));
}

/// Does the plane separate the sides by more than `distance`, times the length of its normal, for the whole step? The
/// comparison is strict and allows for underflow, so that a zero normal separates nothing.
template <EventKind kind>
HWY_INLINE Mask keeps_apart(Point normal, const PairStep& step, Lanes distance) {
  constexpr double underflow = 0x1p-970;  // the least normal number over 2^-52
  const Lanes gap = least_gap(gaps<kind>(normal, step.start), gaps<kind>(normal, step.end));
  return hn::Gt(gap, hn::Add(distance, all(underflow)));
}

HWY_INLINE Lanes magnitude_of(const Point* x) { return max3(sum_norm(x[0]), sum_norm(x[1]), sum_norm(x[2])); }

/// That of RelativeMotion, for a normal of length one.
HWY_INLINE Lanes rounding_of(const PairStep& step) {
  return hn::Mul(all(0x1p-46), hn::Max(magnitude_of(step.start), magnitude_of(step.end)));
}

/// Writes 1 or 0 for each pair of a block, from `apart(step, separation)`, which decides one pair in each lane.
template <Mask (*apart)(const PairStep&, double)>
void flag_pairs(const PairBlock& pairs, const VertexStep* vertices, double separation, unsigned char* result) {
  const Doubles d;
  const std::size_t width = hn::Lanes(d);
  static_assert(PairBlock::capacity % HWY_MAX_BYTES == 0);
  HWY_ALIGN double flags[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t first = 0; first < pairs.count; first += width) {
    hn::Store(hn::IfThenElseZero(apart(load(pairs, first, vertices), separation), all(1)), d, flags);
    for (std::size_t lane = 0; lane < width; ++lane) result[first + lane] = flags[lane] != 0;
  }
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
