// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "stiv/surface.hpp"

namespace stiv {

/// Where an edge goes through a triangle.
struct Piercing {
  std::array<Index, 2> edge{};  ///< smaller vertex first
  Index triangle = 0;
  int step = 0;   ///< from the first vertex on: 1 from the triangle's front to its back, else -1
  double at = 0;  ///< fraction of the edge
};

/// The segment in which two triangles cross.
struct Cut {
  std::array<Index, 2> triangles{};
  std::array<Vector3, 2> ends;
};

/// How two triangles that intersect do so; the piercings at both ends are added. Nothing unless they are in general
/// position: no common vertex, and two edges that go through from one strict side to the other. Exact but for
/// `at` and `ends`.
std::optional<Cut> crossing(const Surface& surface, const Positions& q, const std::array<Index, 2>& triangles,
                            std::vector<Piercing>& piercings);

}  // namespace stiv
