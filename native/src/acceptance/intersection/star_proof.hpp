// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "acceptance/intersection/packed_points.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Stars with the same number of triangles, all closed or all open.
struct StarBlock {
  static constexpr std::size_t capacity = 8;         ///< lanes of the widest vector
  static constexpr std::size_t most_triangles = 32;  ///< of a star

  std::size_t triangles = 0;
  bool closed = false;  ///< the last vertex of each link is its first
  std::array<Index, capacity> vertices{};
  std::array<const Index*, capacity> links{};  ///< triangles + 1 vertices: triangle k is (vertex, link[k], link[k + 1])
  std::size_t count = 0;
};

/// 1 for each star that is proven free: its triangles share only their common corners and edges. 1 is certain; 0 is
/// inconclusive. (mathematics.md, "Stars")
/// @param reach the star is also free wherever each coordinate differs by no more
std::array<unsigned char, StarBlock::capacity> prove_free(const StarBlock& stars, const PackedPoints& points,
                                                          double reach);

}  // namespace stiv
