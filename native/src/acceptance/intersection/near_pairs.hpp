// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Corners of two primitives, as in CornerList.
struct CornerPair {
  std::array<Index, 3> first, second;
};

inline bool share_corner(const std::array<Index, 3>& a, const std::array<Index, 3>& b) {
  bool shared = false;
  for (const Index corner : a) shared |= (corner == b[0]) | (corner == b[1]) | (corner == b[2]);
  return shared;
}

/// Sorts pairs of indices, and keeps each once.
inline void sort_unique(IndexPairs& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Pairs of primitives that may intersect where each coordinate differs by at most `reach` from those of a surface
/// without intersections. (mathematics.md, "Surfaces within rounding")
struct NearPairs {
  double reach = 0;
  std::vector<CornerPair> pairs;  ///< none of them triangles of one star with a link
  std::vector<Index> stars;       ///< vertices of stars with a link that are not proven free within the reach
};

}  // namespace stiv
