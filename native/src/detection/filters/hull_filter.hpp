// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detection/filters/plane_filter.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// How far other steps from the same start may differ: the end of each vertex lies within `slack` times its own
/// displacement (the largest component, less `motion`) of the segment from its start to its end, less `motion`.
struct NearbySteps {
  Vector3 motion = Vector3::Zero();
  double separation = 0;
  double slack = 0;
  double rounding = 0x1p-43;  ///< parts of the coordinates that are allowed for
};

/// 1 for each pair that a direction of the start (the normal, that between the middles, or across an edge) shows apart
/// by more than the separation and all rounding in all nearby steps: it separates the hulls of all that each side may
/// sweep. [docs/mathematics.md, "Rounds of one edit"]
void find_hulls_apart(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, const NearbySteps& steps,
                      PairFlags& apart);

}  // namespace stiv
