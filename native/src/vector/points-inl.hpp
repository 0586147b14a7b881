// SPDX-License-Identifier: GPL-3.0-or-later

// Points in space, one a lane. Included once for each target; see vector/foreach_target.hpp.
#if defined(STIV_VECTOR_POINTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STIV_VECTOR_POINTS_INL
#undef STIV_VECTOR_POINTS_INL
#else
#define STIV_VECTOR_POINTS_INL
#endif

#include "vector/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::ScalableTag<double>;
using Lanes = hn::Vec<Doubles>;  ///< a double a lane
using Mask = hn::Mask<Doubles>;  ///< true or false a lane

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

/// Rows of an array of points, (N, 3) doubles.
HWY_INLINE Point gather_points(const double* rows, const std::int32_t* indices) {
  const hn::RebindToSigned<Doubles> wide;
  const auto index = hn::PromoteTo(wide, hn::LoadU(hn::Rebind<std::int32_t, Doubles>(), indices));
  const auto offset = hn::Add(hn::Add(index, index), index);
  const Doubles d;
  return {hn::GatherIndex(d, rows, offset), hn::GatherIndex(d, rows + 1, offset), hn::GatherIndex(d, rows + 2, offset)};
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
