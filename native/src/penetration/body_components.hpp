// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "stiv/surface.hpp"

namespace stiv {

/// The triangles of a body, ascending, divided by whether their connected component is closed.
struct BodyComponents {
  std::vector<Index> closed;  ///< each edge has as many triangles in one direction as in the other
  std::vector<Index> open;
};

/// The edges of triangles, smaller end first, with more triangles in one direction than in the other.
std::vector<std::array<Index, 2>> boundary_edges(const std::vector<std::array<Index, 3>>& triangles);

BodyComponents body_components(const Surface& surface, Index body);

}  // namespace stiv
