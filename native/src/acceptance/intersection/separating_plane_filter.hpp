// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "acceptance/intersection/packed_points.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Up to `capacity` pairs of triangles, as arrays over the pairs.
struct TrianglePairs {
  static constexpr std::size_t capacity = 64;

  std::array<std::array<Index, capacity>, 6> corners{};  ///< of the first triangle, then of the second
  std::size_t count = 0;

  void add(const std::array<Index, 3>& first, const std::array<Index, 3>& second) {
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k][count] = first[k];
      corners[k + 3][count] = second[k];
    }
    ++count;
  }
};

/// 1 or 0 for each pair of a block.
using TriangleFlags = std::array<unsigned char, TrianglePairs::capacity>;

/// 1 for each pair that one of these planes strictly separates, rounding included: orthogonal to the line through the
/// centers, parallel to a triangle, or orthogonal to a triangle through an edge of it. 1 is certain; 0 is inconclusive.
/// @param reach the plane also separates the pair wherever each coordinate of its corners differs by no more
void find_separated(const TrianglePairs& pairs, const PackedPoints& points, double reach, TriangleFlags& separated);

}  // namespace stiv
