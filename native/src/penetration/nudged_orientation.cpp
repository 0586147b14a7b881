// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/nudged_orientation.hpp"

#include "acceptance/intersection/predicates.hpp"

namespace stiv {

namespace {

/// The sign of v . (e, e^2, e^3): that of the first component that is not zero.
template <class SignOfComponent>
NudgedSign first_sign(int nudge, const SignOfComponent& sign_of_component) {
  for (int axis = 0; axis < 3; ++axis)
    if (const int sign = sign_of_component(axis); sign != 0) return {nudge * sign, true};
  return {0, true};
}

}  // namespace

NudgedSign nudged_side(const Triangle& t, const Vector3& p, int nudge) {
  if (const int sign = orientation_3d(t[0], t[1], t[2], p); sign != 0) return {sign, false};
  return first_sign(-nudge, [&](int axis) { return orientation_2d(t[0], t[1], t[2], axis); });  // along its normal
}

NudgedSign nudged_turn(const Segment& e, const Segment& f, int nudge) {
  if (const int sign = orientation_3d(e[0], e[1], f[0], f[1]); sign != 0) return {sign, false};
  return first_sign(nudge, [&](int axis) { return turn_2d(e[0], e[1], f[0], f[1], axis); });
}

}  // namespace stiv
