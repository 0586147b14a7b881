// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detection/narrow_phase/conservative_advancement.hpp"

namespace stiv {

/// Does a vertex provably slip past an edge, from the end of an advancement to the end of the step? A plane along the
/// edge and its motion shows it, at a tenth of the cost of an advancement in double-doubles. Such pairs are common:
/// where a vertex meets an edge exactly, it misses all but one of the primitives there by rounding.
bool slips_past(const RelativeMotion<DoubleDouble>& motion, double threshold, const Approach<double>& approach);

}  // namespace stiv
