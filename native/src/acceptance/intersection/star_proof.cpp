// SPDX-License-Identifier: GPL-3.0-or-later
// Derivation: mathematics.md, "Stars".
#include "acceptance/intersection/star_proof.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "acceptance/intersection/star_proof.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "vector/points-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

// Each of the six products in a determinant of two differences and an exact direction has at most seven roundings. 32 u
// times a bound on their magnitudes covers that and the rounding of the bound itself.
constexpr double rounding = 32 * 0x1p-53;
// More than the error of a determinant by underflow.
constexpr double underflow = 0x1p-960;

HWY_INLINE Lanes largest(Point a) { return max3(hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)); }

/// The edge from a star's vertex to a vertex of its link.
struct InteriorEdge {
  Point vector;
  Lanes size;
};

/// Turns between interior edges seen along `view`, with their error bounds. These include changes of the edges by twice
/// the reach: a product of sizes then grows by that times their sum, and its square.
struct Turns {
  Point view;
  Lanes scale, change, growth, least;

  Turns(Point along, double reach)
      : view(along),
        scale(hn::Mul(all(rounding * 6), largest(along))),
        change(all(2 * reach)),
        growth(hn::Mul(all((6 + 0x1p-40) * (2 * reach)), largest(along))),
        least(all(underflow)) {}

  Lanes turn(InteriorEdge from, InteriorEdge to) const { return dot(view, cross(from.vector, to.vector)); }
  Lanes error(InteriorEdge from, InteriorEdge to) const {
    const Lanes rounded = hn::Add(hn::Mul(hn::Mul(scale, from.size), to.size), least);
    return hn::Add(rounded, hn::Mul(growth, hn::Add(hn::Add(from.size, to.size), change)));
  }
};

HWY_INLINE Point points_of(const Index* vertices, const PackedPoint* points) {
  const double* rows[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t lane = 0; lane < hn::Lanes(Doubles()); ++lane) rows[lane] = points[vertices[lane]].coordinates;
  return load_points(rows);
}

/// Processes one star in each lane, starting with `first`.
HWY_INLINE Mask proven(const StarBlock& stars, std::size_t first, const PackedPoint* points, double reach) {
  const Doubles d;
  const Point centre = points_of(stars.vertices.data() + first, points);
  InteriorEdge edges[StarBlock::most_triangles + 1];
  for (std::size_t k = 0; k <= stars.triangles; ++k) {
    Index around[HWY_MAX_BYTES / sizeof(double)];
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) around[lane] = stars.links[first + lane][k];
    edges[k].vector = points_of(around, points) - centre;
    edges[k].size = largest(edges[k].vector);
  }
  Point view{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (std::size_t k = 0; k < stars.triangles; ++k) view = view + cross(edges[k].vector, edges[k + 1].vector);

  const Turns turns(view, reach);
  Mask free = hn::Eq(hn::Zero(d), hn::Zero(d)),
       before = hn::Not(free);  // edge k may not lie left of edge 0
  for (std::size_t k = 0; k < stars.triangles; ++k) {
    free = hn::And(free, hn::Gt(turns.turn(edges[k], edges[k + 1]), turns.error(edges[k], edges[k + 1])));
    const Lanes turn = turns.turn(edges[0], edges[k + 1]), error = turns.error(edges[0], edges[k + 1]);
    // Does triangle k contain the first edge, other than as a side of its own?
    const bool on_it = k == 0 || (stars.closed && k + 1 == stars.triangles);
    if (!on_it) free = hn::AndNot(hn::AndNot(hn::Lt(turn, hn::Neg(error)), before), free);
    before = hn::Not(hn::Gt(turn, error));
  }
  return free;
}

void prove_stars(const StarBlock& stars, const PackedPoint* points, double reach, unsigned char* free) {
  const Doubles d;
  static_assert(HWY_MAX_BYTES / sizeof(double) <= StarBlock::capacity);
  HWY_ALIGN double flags[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t first = 0; first < stars.count; first += hn::Lanes(d)) {
    hn::Store(hn::IfThenElseZero(proven(stars, first, points, reach), all(1)), d, flags);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) free[first + lane] = flags[lane] != 0;
  }
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

std::array<unsigned char, StarBlock::capacity> prove_free(const StarBlock& stars, const PackedPoints& points,
                                                          double reach) {
  StarBlock whole = stars;  // unused lanes repeat the last star
  for (std::size_t k = stars.count; k < StarBlock::capacity; ++k) {
    whole.vertices[k] = stars.vertices[stars.count - 1];
    whole.links[k] = stars.links[stars.count - 1];
  }
  std::array<unsigned char, StarBlock::capacity> free{};
  STIV_FOR_VECTOR_TARGET(prove_stars)(whole, points.data(), reach, free.data());
  return free;
}

}  // namespace stiv
#endif
