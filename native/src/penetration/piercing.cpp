// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/piercing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "acceptance/intersection/predicates.hpp"

namespace stiv {

namespace {

/// Fraction of the segment at its intersection with the plane of the triangle.
double fraction_at(const Segment& segment, const Triangle& t) {
  const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double from = std::abs(normal.dot(segment[0] - t[0])), to = std::abs(normal.dot(segment[1] - t[0]));
  return from + to > 0 ? from / (from + to) : 0.5;
}

/// Barycentric weights from the volumes of the segment with each side. All have the same sign; rounding errors of the
/// opposite sign count as 0.
Eigen::Vector2d weights_in(const Triangle& t, const Segment& segment, int sign) {
  const Vector3 along = segment[1] - segment[0];
  const auto volume_over = [&](std::size_t k) {
    const Vector3 from = t[k] - segment[0], to = t[(k + 1) % 3] - segment[0];
    return std::max(-sign * along.dot(from.cross(to)), 0.0);
  };
  const double third = volume_over(0), first = volume_over(1), second = volume_over(2), sum = first + second + third;
  return sum > 0 ? Eigen::Vector2d(second / sum, third / sum) : Eigen::Vector2d::Constant(1.0 / 3);
}

/// The sign of v . (e, e^2, e^3): that of the first nonzero component.
template <class SignOfComponent>
PerturbedSign first_sign(int perturbation, const SignOfComponent& sign_of_component) {
  for (int axis = 0; axis < 3; ++axis)
    if (const int sign = sign_of_component(axis); sign != 0) return {perturbation * sign, true};
  return {0, true};
}

}  // namespace

PerturbedSign perturbed_side(const Triangle& t, const Vector3& p, int perturbation) {
  if (const int sign = orientation_3d(t[0], t[1], t[2], p); sign != 0) return {sign, false};
  return first_sign(-perturbation,
                    [&](int axis) { return orientation_2d(t[0], t[1], t[2], axis); });  // components of its normal
}

PerturbedSign perturbed_turn(const Segment& e, const Segment& f, int perturbation) {
  if (const int sign = orientation_3d(e[0], e[1], f[0], f[1]); sign != 0) return {sign, false};
  return first_sign(perturbation, [&](int axis) { return turn_2d(e[0], e[1], f[0], f[1], axis); });
}

std::optional<Piercing> piercing(const Segment& segment, const Triangle& triangle, int perturbation, bool& touching) {
  const PerturbedSign from = perturbed_side(triangle, segment[0], perturbation),
                      to = perturbed_side(triangle, segment[1], perturbation);
  touching = touching || from.touching || to.touching;
  if (from.value * to.value >= 0) return std::nullopt;
  std::array<int, 3> turns{};
  for (std::size_t k = 0; k < 3; ++k) {
    const PerturbedSign turn = perturbed_turn(segment, {triangle[k], triangle[(k + 1) % 3]}, -perturbation);
    touching = touching || turn.touching;
    turns[k] = turn.value;
  }
  const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
  if (*least < 0 && *most > 0) return std::nullopt;
  const int step = to.value;  // positive below the triangle
  return Piercing{step, fraction_at(segment, triangle), weights_in(triangle, segment, *least < 0 ? -1 : 1)};
}

}  // namespace stiv
