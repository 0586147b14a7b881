// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/separating_plane_filter.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "acceptance/intersection/separating_plane_filter.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "vector/points-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// One pair in each lane, relative to the first corner of the first triangle: its other two, then those of the second.
struct Pair {
  Point first[2], second[3];
  Point magnitude;  ///< of the coordinates
  Lanes shrinkage;  ///< of a gap along a direction with components of 1, if all corners move by the reach
};

HWY_INLINE Point magnitude(Point a) { return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)}; }
HWY_INLINE Point larger(Point a, Point b) { return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)}; }

HWY_INLINE Point load_corners(const TrianglePairs& pairs, std::size_t corner, std::size_t at,
                              const PackedPoint* points) {
  const double* rows[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t lane = 0; lane < hn::Lanes(Doubles()); ++lane)
    rows[lane] = points[pairs.corners[corner][at + lane]].coordinates;
  return load_points(rows);
}

HWY_INLINE Pair load(const TrianglePairs& pairs, std::size_t at, const PackedPoint* points, double reach) {
  const Point origin = load_corners(pairs, 0, at, points);
  Pair pair;
  for (std::size_t k = 0; k < 2; ++k) pair.first[k] = load_corners(pairs, k + 1, at, points) - origin;
  for (std::size_t k = 0; k < 3; ++k) pair.second[k] = load_corners(pairs, k + 3, at, points) - origin;
  pair.magnitude = larger(magnitude(pair.first[0]), magnitude(pair.first[1]));
  for (const Point& corner : pair.second) pair.magnitude = larger(pair.magnitude, magnitude(corner));
  pair.shrinkage = all((2 + 0x1p-40) * reach);  // rounding included
  return pair;
}

/// Any direction is valid, rounded or not. A height along it is a sum of three products of differences, with an error
/// of at most ((1 + u)^4 - 1) times the sum of their magnitudes. 16 u covers twice that and the rounding of the bound.
HWY_INLINE Mask separates(Point direction, const Pair& pair) {
  constexpr double underflow = 0x1p-970;
  const Lanes zero = hn::Zero(Doubles());
  const Lanes a1 = dot(direction, pair.first[0]), a2 = dot(direction, pair.first[1]);
  const Lanes b0 = dot(direction, pair.second[0]), b1 = dot(direction, pair.second[1]),
              b2 = dot(direction, pair.second[2]);
  const Lanes beyond = hn::Sub(min3(b0, b1, b2), max3(zero, a1, a2));
  const Lanes before = hn::Sub(min3(zero, a1, a2), max3(b0, b1, b2));
  const Lanes error = hn::Mul(all(0x1p-49), dot(magnitude(direction), pair.magnitude));
  const Lanes least = hn::Add(error, hn::Mul(pair.shrinkage, sum_norm(direction)));
  return hn::Gt(hn::Max(beyond, before), hn::Add(least, all(underflow)));
}

HWY_INLINE Mask over_edges(Point normal, Point a, Point b, Point c, const Pair& pair) {
  const Mask ab = separates(cross(b - a, normal), pair), bc = separates(cross(c - b, normal), pair);
  return hn::Or(hn::Or(ab, bc), separates(cross(a - c, normal), pair));
}

HWY_INLINE Mask separated(const Pair& pair) {
  const Doubles d;
  const Point origin = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  const Point centres = pair.second[0] + pair.second[1] + pair.second[2] - pair.first[0] - pair.first[1];
  const Point first = cross(pair.first[0], pair.first[1]);
  const Point second = cross(pair.second[1] - pair.second[0], pair.second[2] - pair.second[0]);
  const Mask parallel = hn::Or(separates(first, pair), separates(second, pair));
  const Mask quick = hn::Or(separates(centres, pair), parallel);
  if (hn::AllTrue(d, quick)) return quick;
  const Mask upright = hn::Or(over_edges(first, origin, pair.first[0], pair.first[1], pair),
                              over_edges(second, pair.second[0], pair.second[1], pair.second[2], pair));
  return hn::Or(quick, upright);
}

void find_separated(const TrianglePairs& pairs, const PackedPoint* points, double reach, unsigned char* result) {
  const Doubles d;
  const std::size_t width = hn::Lanes(d);
  static_assert(TrianglePairs::capacity % HWY_MAX_BYTES == 0);
  HWY_ALIGN double flags[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t at = 0; at < pairs.count; at += width) {
    hn::Store(hn::IfThenElseZero(separated(load(pairs, at, points, reach)), all(1)), d, flags);
    for (std::size_t lane = 0; lane < width; ++lane) result[at + lane] = flags[lane] != 0;
  }
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void find_separated(const TrianglePairs& pairs, const PackedPoints& points, double reach, TriangleFlags& separated) {
  STIV_FOR_VECTOR_TARGET(find_separated)(pairs, points.data(), reach, separated.data());
}

}  // namespace stiv
#endif
