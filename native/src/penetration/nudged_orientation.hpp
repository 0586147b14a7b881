// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "acceptance/intersection/exact_meeting.hpp"

namespace stiv {

/// Signs of orientation_3d between two bodies, of which one is moved by an infinitely small `nudge` * (e, e^2, e^3),
/// nudge 1 or -1: bodies that touch, in coplanar faces, edges or corners, cross or are apart then, and every answer
/// agrees with every other, since they are those of one placement in general position. (mathematics.md, "Excluded
/// pairs"; the idea is that of Edelsbrunner, Mücke, Simulation of simplicity, 1990)
struct NudgedSign {
  int value = 0;          ///< 0 only where a triangle has no area, or edges are parallel
  bool touching = false;  ///< without the nudge it would be 0
};

/// orientation_3d(t0, t1, t2, p), the point nudged.
NudgedSign nudged_side(const Triangle& t, const Vector3& p, int nudge);

/// orientation_3d(e0, e1, f0, f1), the second edge nudged.
NudgedSign nudged_turn(const Segment& e, const Segment& f, int nudge);

}  // namespace stiv
