// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detection/filters/plane_filter.hpp"

namespace stiv {

/// 1 for each pair that the plane across the nearest points of its start shows apart for the whole step, by more than
/// `separation` and all rounding, if one of these lies on the rim of its side: the normals that the plane filter tries
/// serve the others. Takes longer than that filter, and leaves little of what is near each other but does not meet.
void find_rims_apart(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                     PairFlags& apart);

}  // namespace stiv
