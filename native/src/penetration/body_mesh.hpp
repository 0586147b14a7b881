// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "stiv/surface.hpp"

namespace stiv {

/// Triangles of a body by themselves, with vertices counted from 0: what is done with one body takes no time for the
/// others.
struct BodyMesh {
  std::vector<Index> vertices;                ///< of the surface, ascending
  std::vector<Index> triangles;               ///< of the surface, ascending
  std::vector<std::array<Index, 3>> corners;  ///< of each triangle, places in `vertices`
  std::vector<Index> seeds;                   ///< a vertex of each component, a place in `vertices`
  std::vector<std::array<Index, 2>> walk;     ///< edges (from, to) that lead from the seeds to all others, in order
};

/// @param triangles of the surface, ascending
BodyMesh body_mesh(const Surface& surface, std::vector<Index> triangles);

}  // namespace stiv
