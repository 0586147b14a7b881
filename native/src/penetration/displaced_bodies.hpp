// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/surface.hpp"

namespace stiv {

/// Marks the bodies, by number, of which a vertex differs in any bit between two positions, (N, 3) each.
std::vector<unsigned char> displaced_bodies(const Surface& surface, const Positions& from, const Positions& to);

}  // namespace stiv
