// SPDX-License-Identifier: GPL-3.0-or-later
// Exact signs of determinants, after J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates", Discrete & Computational Geometry 18, 1997.
#include "acceptance/intersection/predicates.hpp"

#include <cmath>

#include "acceptance/intersection/expansion_arithmetic.hpp"

namespace stiv {

namespace {

constexpr double epsilon = 0x1p-53;  // half a unit in the last place of 1

// Bounds of the rounding error of the determinants below, differences included, as multiples of the sum of the
// magnitudes of their products. [Shewchuk 1997, tables 2 and 3, bounds A]
constexpr double error_2d = (3 + 16 * epsilon) * epsilon;
constexpr double error_3d = (7 + 56 * epsilon) * epsilon;

int sign_of(double value) { return (value > 0) - (value < 0); }

/// True if rounding cannot have changed the sign: |value| is above the error bound, or the bound is 0 because each
/// product has a factor of exactly 0.
bool is_certain(double value, double bound) { return std::abs(value) > bound || bound == 0; }

Expansion<16> exact_minor(const Expansion<2>& ax, const Expansion<2>& ay, const Expansion<2>& bx,
                          const Expansion<2>& by) {
  return ax * by - bx * ay;
}

int exact_orientation_3d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const auto edge = [&](const Vector3& from, int axis) { return exact_difference(from[axis], d[axis]); };
  const Expansion<2> ax = edge(a, 0), ay = edge(a, 1), bx = edge(b, 0), by = edge(b, 1), cx = edge(c, 0),
                     cy = edge(c, 1);
  const Expansion<64> bc = exact_minor(bx, by, cx, cy) * edge(a, 2);
  const Expansion<64> ca = exact_minor(cx, cy, ax, ay) * edge(b, 2);
  const Expansion<64> ab = exact_minor(ax, ay, bx, by) * edge(c, 2);
  return (bc + ca + ab).sign();
}

}  // namespace

int orientation_3d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const Vector3 ad = a - d, bd = b - d, cd = c - d;
  const double bx_cy = bd.x() * cd.y(), cx_by = cd.x() * bd.y();
  const double cx_ay = cd.x() * ad.y(), ax_cy = ad.x() * cd.y();
  const double ax_by = ad.x() * bd.y(), bx_ay = bd.x() * ad.y();
  const double determinant = ad.z() * (bx_cy - cx_by) + bd.z() * (cx_ay - ax_cy) + cd.z() * (ax_by - bx_ay);
  const double magnitude = (std::abs(bx_cy) + std::abs(cx_by)) * std::abs(ad.z()) +
                           (std::abs(cx_ay) + std::abs(ax_cy)) * std::abs(bd.z()) +
                           (std::abs(ax_by) + std::abs(bx_ay)) * std::abs(cd.z());
  if (is_certain(determinant, error_3d * magnitude)) return sign_of(determinant);
  return exact_orientation_3d(a, b, c, d);
}

int orientation_2d(const Vector3& a, const Vector3& b, const Vector3& c, int drop) { return turn_2d(c, a, c, b, drop); }

int turn_2d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d, int drop) {
  const int x = (drop + 1) % 3, y = (drop + 2) % 3;
  const double left = (b[x] - a[x]) * (d[y] - c[y]);
  const double right = (b[y] - a[y]) * (d[x] - c[x]);
  const double determinant = left - right;
  if (is_certain(determinant, error_2d * (std::abs(left) + std::abs(right)))) return sign_of(determinant);
  return exact_minor(exact_difference(b[x], a[x]), exact_difference(b[y], a[y]), exact_difference(d[x], c[x]),
                     exact_difference(d[y], c[y]))
      .sign();
}

}  // namespace stiv
