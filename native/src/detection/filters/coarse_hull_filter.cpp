// SPDX-License-Identifier: GPL-3.0-or-later
// Derivation: mathematics.md, "Filter".
#include "detection/filters/coarse_hull_filter.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/filters/coarse_hull_filter.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "vector/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Singles = hn::CappedTag<float, 8>;
using SingleLanes = hn::Vec<Singles>;
using SingleMask = hn::Mask<Singles>;

HWY_INLINE SingleLanes single(float value) { return hn::Set(Singles(), value); }

// Short names for long error bounds.
HWY_INLINE SingleLanes sum(SingleLanes a, SingleLanes b) { return hn::Add(a, b); }
HWY_INLINE SingleLanes sum(SingleLanes a, SingleLanes b, SingleLanes c) { return hn::Add(hn::Add(a, b), c); }
HWY_INLINE SingleLanes scaled(float factor, SingleLanes a) { return hn::Mul(single(factor), a); }

struct CoarsePoint {
  SingleLanes x, y, z;
};

HWY_INLINE CoarsePoint operator+(CoarsePoint a, CoarsePoint b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE CoarsePoint operator-(CoarsePoint a, CoarsePoint b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE CoarsePoint operator*(SingleLanes s, CoarsePoint a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
HWY_INLINE SingleLanes dot(CoarsePoint a, CoarsePoint b) {
  return sum(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z));
}
HWY_INLINE CoarsePoint cross(CoarsePoint a, CoarsePoint b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE SingleLanes sum_norm(CoarsePoint a) { return sum(hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)); }
HWY_INLINE SingleLanes largest(CoarsePoint a) { return hn::Max(hn::Max(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z)); }

/// One pair in each lane, relative to the start of its first vertex, which is left out. In multiples of the unit of
/// coarse steps: products of four coordinates do not overflow.
struct CoarseHulls {
  CoarsePoint start[4], end[4];
};

using Integers = hn::RebindToSigned<Singles>;

struct IntegerPoint {
  hn::Vec<Integers> x, y, z;
};

/// The first three of four numbers in each row.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE IntegerPoint load_integer_points(const std::int32_t* const* rows, std::size_t offset) {
  const Integers d;
  return {hn::Set(d, rows[0][offset]), hn::Set(d, rows[0][offset + 1]), hn::Set(d, rows[0][offset + 2])};
}
#else
HWY_INLINE IntegerPoint load_integer_points(const std::int32_t* const* rows, std::size_t offset) {
  const Integers d;
  hn::Vec<Integers> r[4];
  for (std::size_t k = 0; k < 4; ++k) {
#if HWY_MAX_BYTES >= 32
    const hn::Half<Integers> four;
    r[k] = hn::Combine(d, hn::Load(four, rows[k + 4] + offset), hn::Load(four, rows[k] + offset));
#else
    r[k] = hn::Load(d, rows[k] + offset);
#endif
  }
  const auto low02 = hn::InterleaveLower(d, r[0], r[2]), low13 = hn::InterleaveLower(d, r[1], r[3]);
  const auto high02 = hn::InterleaveUpper(d, r[0], r[2]), high13 = hn::InterleaveUpper(d, r[1], r[3]);
  return {hn::InterleaveLower(d, low02, low13), hn::InterleaveUpper(d, low02, low13),
          hn::InterleaveLower(d, high02, high13)};
}
#endif

/// Differences do not overflow, and are rounded once.
HWY_INLINE CoarsePoint relative_to(IntegerPoint origin, IntegerPoint point) {
  const Singles d;
  return {hn::ConvertTo(d, hn::Sub(point.x, origin.x)), hn::ConvertTo(d, hn::Sub(point.y, origin.y)),
          hn::ConvertTo(d, hn::Sub(point.z, origin.z))};
}

/// The steps of the vertices of one pair in each lane; the last pair in the lanes beyond it.
struct CoarseRows {
  const std::int32_t* of[4][8];
};

HWY_INLINE CoarseRows rows_of(const PairView& pairs, std::size_t begin, const CoarseStep* vertices) {
  CoarseRows rows;
  for (std::size_t lane = 0; lane < hn::Lanes(Singles()); ++lane) {
    const std::size_t k = begin + lane < pairs.count ? begin + lane : pairs.count - 1;
    for (std::size_t corner = 0; corner < 4; ++corner)
      rows.of[corner][lane] = vertices[pairs.vertices[corner][k]].start;
  }
  return rows;
}

HWY_INLINE CoarseHulls hulls_of(const CoarseRows& rows) {
  const IntegerPoint origin = load_integer_points(rows.of[0], 0);
  CoarseHulls hulls;
  hulls.end[0] = relative_to(origin, load_integer_points(rows.of[0], 4));
  for (std::size_t k = 1; k < 4; ++k) {
    hulls.start[k] = relative_to(origin, load_integer_points(rows.of[k], 0));
    hulls.end[k] = relative_to(origin, load_integer_points(rows.of[k], 4));
  }
  return hulls;
}

/// The gap between the sides' ranges along a direction, whichever comes first.
template <EventKind kind>
HWY_INLINE SingleLanes gap(CoarsePoint normal, const CoarseHulls& hulls) {
  SingleLanes low[4], high[4];
  for (std::size_t k = 0; k < 4; ++k) {
    const SingleLanes end = dot(normal, hulls.end[k]);
    const SingleLanes start = k == 0 ? hn::Zero(Singles()) : dot(normal, hulls.start[k]);
    low[k] = hn::Min(start, end);
    high[k] = hn::Max(start, end);
  }
  const SingleLanes low23 = hn::Min(low[2], low[3]), high23 = hn::Max(high[2], high[3]);
  if constexpr (kind == EventKind::vertex_face)
    return hn::Max(hn::Sub(low[0], hn::Max(high[1], high23)), hn::Sub(hn::Min(low[1], low23), high[0]));
  return hn::Max(hn::Sub(hn::Min(low[0], low[1]), high23), hn::Sub(low23, hn::Max(high[0], high[1])));
}

/// Bounds for the pair in each lane.
struct CoarseErrors {
  SingleLanes of_edge;    ///< of a coordinate, and of a difference of two
  SingleLanes by_length;  ///< of a gap, over the sum of the direction's components
  SingleLanes by_error;   ///< of a gap, over the error of a component of the direction
};

HWY_INLINE CoarseErrors errors_of(const CoarseHulls& hulls, const CoarseBounds& bounds) {
  SingleLanes most = largest(hulls.end[0]);
  for (std::size_t k = 1; k < 4; ++k) most = hn::Max(most, hn::Max(largest(hulls.start[k]), largest(hulls.end[k])));
  constexpr float more = 1 + 0x1p-10F;
  const SingleLanes of_edge = sum(single(2), scaled(0x1p-22F, most)), clearance = single(bounds.clearance);
  return {of_edge, scaled(more, sum(clearance, scaled(4, of_edge))),
          scaled(more, sum(scaled(6, sum(most, of_edge)), scaled(3, clearance)))};
}

/// Of the normal: the cross product of two vectors with these largest components.
HWY_INLINE SingleLanes error_of_normal(SingleLanes a, SingleLanes b, SingleLanes of_edge) {
  return sum(hn::Mul(of_edge, sum(scaled(3, sum(a, b)), scaled(8, of_edge))), scaled(0x1p-21F, hn::Mul(a, b)));
}

/// Of the direction across an edge, from its largest component and that of the direction between the middles.
HWY_INLINE SingleLanes error_of_across(SingleLanes edge, SingleLanes way, SingleLanes of_edge) {
  const SingleLanes square = hn::Mul(edge, edge), length = sum(edge, way);
  return sum(hn::Mul(scaled(16, of_edge), hn::Mul(edge, length)), scaled(0x1p-18F, hn::Mul(square, way)),
             hn::Mul(scaled(64, hn::Mul(of_edge, of_edge)), sum(length, of_edge)));
}

/// @param error of a component of the direction
template <EventKind kind>
HWY_INLINE SingleMask separates(CoarsePoint normal, SingleLanes error, const CoarseHulls& hulls,
                                const CoarseErrors& errors) {
  const SingleLanes least =
      sum(hn::Mul(errors.by_length, sum_norm(normal)), hn::Mul(errors.by_error, error), single(0x1p-100F));
  return hn::Gt(gap<kind>(normal, hulls), least);
}

template <EventKind kind>
HWY_INLINE SingleMask are_coarse_hulls_apart(const CoarseHulls& hulls, const CoarseBounds& bounds) {
  const CoarseErrors errors = errors_of(hulls, bounds);
  const CoarsePoint* const x = hulls.start + 1;
  constexpr bool is_face = kind == EventKind::vertex_face;

  const CoarsePoint first = is_face ? x[1] - x[0] : x[0], second = is_face ? x[2] - x[0] : x[2] - x[1];
  const SingleLanes of_normal = error_of_normal(largest(first), largest(second), errors.of_edge);
  const SingleMask by_normal = separates<kind>(cross(first, second), of_normal, hulls, errors);
  if (hn::AllTrue(Singles(), by_normal)) return by_normal;

  const CoarsePoint middles = is_face ? x[0] + x[1] + x[2] : x[1] + x[2] - x[0];
  const SingleMask apart = hn::Or(by_normal, separates<kind>(middles, scaled(2, errors.of_edge), hulls, errors));
  if constexpr (is_face) return apart;
  if (hn::AllTrue(Singles(), apart)) return apart;

  const CoarsePoint across = dot(x[0], x[0]) * middles - dot(x[0], middles) * x[0];
  const SingleLanes of_across = error_of_across(largest(x[0]), largest(middles), errors.of_edge);
  return hn::Or(apart, separates<kind>(across, of_across, hulls, errors));
}

template <EventKind kind>
std::uint64_t find_apart_by_coarse_hulls_of_kind(const PairView& pairs, const CoarseStep* vertices,
                                                 const CoarseBounds& bounds) {
  static_assert(PairBlock::capacity <= 64);
  const Singles d;
  std::uint64_t apart = 0;
  for (std::size_t begin = 0; begin < pairs.count; begin += hn::Lanes(d)) {
    unsigned char bits[8] = {};
    const CoarseHulls hulls = hulls_of(rows_of(pairs, begin, vertices));
    hn::StoreMaskBits(d, are_coarse_hulls_apart<kind>(hulls, bounds), bits);
    apart |= std::uint64_t{bits[0]} << begin;
  }
  return apart;
}

std::uint64_t find_apart_by_coarse_hulls(EventKind kind, const PairView& pairs, const CoarseStep* vertices,
                                         const CoarseBounds& bounds) {
  if (kind == EventKind::vertex_face)
    return find_apart_by_coarse_hulls_of_kind<EventKind::vertex_face>(pairs, vertices, bounds);
  return find_apart_by_coarse_hulls_of_kind<EventKind::edge_edge>(pairs, vertices, bounds);
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

std::uint64_t find_apart_by_coarse_hulls(EventKind kind, const PairView& pairs, const CoarseStep* vertices,
                                         const CoarseBounds& bounds) {
  return STIV_FOR_VECTOR_TARGET(find_apart_by_coarse_hulls)(kind, pairs, vertices, bounds);
}

}  // namespace stiv
#endif
