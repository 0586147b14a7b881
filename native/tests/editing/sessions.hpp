// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/small_scenes.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/editing/session.hpp"

// Helpers of the tests of sessions for the small scenes.
namespace stiv::tests {

inline constexpr Index upper_sheet = 49;  // vertices of two_sheets' first body

inline EditSession session_of(const Scene& scene, const EditOptions& options = {}) {
  return EditSession(scene.surface, scene.deformation, scene.controls, options);
}

/// The first rows moved.
inline Controls moved(const Controls& p, Index rows, const Vector3& offset) {
  Controls goal = p;
  goal.topRows(rows).rowwise() += offset.transpose();
  return goal;
}

inline bool is_free(const Scene& scene, const Positions& q) {
  Execution execution(1);
  return IntersectionTest(scene.surface).find(q, execution).empty();
}

}  // namespace stiv::tests
