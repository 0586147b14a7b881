// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "penetration/crossings.hpp"

namespace stiv {

/// For each triangle of the body of a side, the mean over it of how often the other body, which is closed, winds around
/// its points: the part of its area that lies inside, where that faces outward. (mathematics.md, "Excluded pairs")
std::vector<double> mean_windings(const Crossings& crossings, std::size_t side);

}  // namespace stiv
