// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detection/filters/plane_filter.hpp"

namespace stiv {

/// 1 for each pair that a plane across one of the axes keeps farther apart than `separation` for the whole step: at its
/// start and at its end the same side lies beyond the other. Rounding is not allowed for.
void find_boxes_apart(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                      PairFlags& apart);

}  // namespace stiv
