// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

namespace stiv {

/// From when on two primitives count as interfering. [DESIGN 3, "Events at a distance"]
struct Proximity {
  double separation = 0;  ///< h >= 0, in the units of the positions
  double keep = 0.5;      ///< in (0, 1): pairs that start nearer than h keep this fraction of their distance instead

  /// h_eff = min(h, keep d0) for a pair at distance d0 at the start of the step.
  double threshold(double start_distance) const { return std::min(separation, keep * start_distance); }

  /// min(2h, d0): the distance that the response aims for; h itself would be met again at once.
  double target(double start_distance) const { return std::min(2 * separation, start_distance); }
};

}  // namespace stiv
