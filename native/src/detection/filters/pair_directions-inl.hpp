// SPDX-License-Identifier: GPL-3.0-or-later

// Directions along which the two sides of a pair may be apart, not normalized. The points are the second, third and
// fourth vertex relative to the first. Included once for each target; see vector/foreach_target.hpp.
#if defined(STIV_PAIR_DIRECTIONS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STIV_PAIR_DIRECTIONS_INL
#undef STIV_PAIR_DIRECTIONS_INL
#else
#define STIV_PAIR_DIRECTIONS_INL
#endif

#include "stiv/detection/event.hpp"
#include "vector/points-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// Normal of the face, or of both edges.
template <EventKind kind>
HWY_INLINE Point normal_of(const Point* x) {
  return kind == EventKind::vertex_face ? cross(x[1] - x[0], x[2] - x[0]) : cross(x[0], x[2] - x[1]);
}

/// From the middle of the second side to that of the first, times a factor.
template <EventKind kind>
HWY_INLINE Point between_middles(const Point* x) {
  return kind == EventKind::vertex_face ? x[0] + x[1] + x[2] : x[1] + x[2] - x[0];
}

/// The component of a direction orthogonal to an edge, times a factor: separates edges that are parallel, such as those
/// of a flat mesh, whose common normal vanishes.
HWY_INLINE Point across(Point edge, Point direction) {
  return dot(edge, edge) * direction - dot(edge, direction) * edge;
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
