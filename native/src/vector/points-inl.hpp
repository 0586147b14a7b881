// SPDX-License-Identifier: GPL-3.0-or-later

// Points in space, one in each lane. Included once for each target; see vector/foreach_target.hpp.
#if defined(STIV_VECTOR_POINTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STIV_VECTOR_POINTS_INL
#undef STIV_VECTOR_POINTS_INL
#else
#define STIV_VECTOR_POINTS_INL
#endif

#include "vector/doubles-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

HWY_INLINE Lanes all(double value) { return hn::Set(Doubles(), value); }

struct Point {
  Lanes x, y, z;
};

HWY_INLINE Point operator+(Point a, Point b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }
HWY_INLINE Point operator-(Point a, Point b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE Point operator*(Lanes s, Point a) { return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)}; }

HWY_INLINE Lanes dot(Point a, Point b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Point cross(Point a, Point b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
/// Sum of magnitudes, no less than the length.
HWY_INLINE Lanes sum_norm(Point a) { return hn::Add(hn::Add(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z)); }

HWY_INLINE Lanes min3(Lanes a, Lanes b, Lanes c) { return hn::Min(hn::Min(a, b), c); }
HWY_INLINE Lanes max3(Lanes a, Lanes b, Lanes c) { return hn::Max(hn::Max(a, b), c); }

/// The first eight doubles of a row in each lane: x, y, z and padding, twice.
struct TwoPoints {
  Point first, second;
};

// load_rows gives both, load_points the first; rows are aligned to their size.

#if HWY_MAX_BYTES == 64
// Pairs of rows are interleaved, which leaves blocks of two lanes (x x | z z | x' x' | z' z') and (y y | - | y' y' | -)
// for each pair of rows, and then the blocks of four pairs are transposed.
HWY_INLINE Lanes first_blocks(Lanes halves01, Lanes halves23) {
  return hn::OddEvenBlocks(hn::SwapAdjacentBlocks(halves23), halves01);
}
HWY_INLINE Lanes second_blocks(Lanes halves01, Lanes halves23) {
  return hn::OddEvenBlocks(halves23, hn::SwapAdjacentBlocks(halves01));
}
HWY_INLINE TwoPoints load_rows(const double* const* rows) {
  const Doubles d;
  Lanes xz[4], y[4];
  for (int k = 0; k < 4; ++k) {
    const Lanes even = hn::Load(d, rows[2 * k]), odd = hn::Load(d, rows[2 * k + 1]);
    xz[k] = hn::InterleaveLower(d, even, odd);
    y[k] = hn::InterleaveUpper(d, even, odd);
  }
  const Lanes low02 = hn::ConcatLowerLower(d, xz[2], xz[0]), low13 = hn::ConcatLowerLower(d, xz[3], xz[1]);
  const Lanes high02 = hn::ConcatUpperUpper(d, xz[2], xz[0]), high13 = hn::ConcatUpperUpper(d, xz[3], xz[1]);
  const Lanes y02 = hn::ConcatLowerLower(d, y[2], y[0]), y13 = hn::ConcatLowerLower(d, y[3], y[1]);
  const Lanes z02 = hn::ConcatUpperUpper(d, y[2], y[0]), z13 = hn::ConcatUpperUpper(d, y[3], y[1]);
  return {{first_blocks(low02, low13), first_blocks(y02, y13), second_blocks(low02, low13)},
          {first_blocks(high02, high13), first_blocks(z02, z13), second_blocks(high02, high13)}};
}
HWY_INLINE Point load_points(const double* const* rows) {
  const Doubles d;
  const hn::Half<Doubles> half;
  Lanes two[4];  // rows k and k + 4
  for (int k = 0; k < 4; ++k) two[k] = hn::Combine(d, hn::Load(half, rows[k + 4]), hn::Load(half, rows[k]));
  const Lanes xz01 = hn::InterleaveLower(d, two[0], two[1]), xz23 = hn::InterleaveLower(d, two[2], two[3]);
  const Lanes y01 = hn::InterleaveUpper(d, two[0], two[1]), y23 = hn::InterleaveUpper(d, two[2], two[3]);
  return {first_blocks(xz01, xz23), first_blocks(y01, y23), second_blocks(xz01, xz23)};
}
#elif HWY_MAX_BYTES == 32
HWY_INLINE Point load_four(const double* const* rows, std::size_t offset) {
  const Doubles d;
  const Lanes a = hn::Load(d, rows[0] + offset), b = hn::Load(d, rows[1] + offset);
  const Lanes e = hn::Load(d, rows[2] + offset), f = hn::Load(d, rows[3] + offset);
  const Lanes xz01 = hn::InterleaveLower(d, a, b), xz23 = hn::InterleaveLower(d, e, f);
  const Lanes y01 = hn::InterleaveUpper(d, a, b), y23 = hn::InterleaveUpper(d, e, f);
  return {hn::ConcatLowerLower(d, xz23, xz01), hn::ConcatLowerLower(d, y23, y01), hn::ConcatUpperUpper(d, xz23, xz01)};
}
HWY_INLINE TwoPoints load_rows(const double* const* rows) { return {load_four(rows, 0), load_four(rows, 4)}; }
HWY_INLINE Point load_points(const double* const* rows) { return load_four(rows, 0); }
#else
HWY_INLINE Lanes load_column(const double* const* rows, std::size_t column) {
  const Doubles d;
  HWY_ALIGN double values[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) values[lane] = rows[lane][column];
  return hn::Load(d, values);
}
HWY_INLINE TwoPoints load_rows(const double* const* rows) {
  return {{load_column(rows, 0), load_column(rows, 1), load_column(rows, 2)},
          {load_column(rows, 4), load_column(rows, 5), load_column(rows, 6)}};
}
HWY_INLINE Point load_points(const double* const* rows) {
  return {load_column(rows, 0), load_column(rows, 1), load_column(rows, 2)};
}
#endif

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
