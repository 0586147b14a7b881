// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "acceptance/intersection/point_rows.hpp"

namespace stiv {

/// Stars of equally many triangles, closed or open all of them, side by side.
struct StarBlock {
  static constexpr std::size_t capacity = 8;         ///< no vector has more lanes
  static constexpr std::size_t most_triangles = 32;  ///< of a star

  std::size_t triangles = 0;
  bool closed = false;  ///< the last vertex of a rim is the first
  std::array<Index, capacity> vertices{};
  std::array<const Index*, capacity> rims{};  ///< triangles + 1 vertices: triangle k is (vertex, rim k, rim k + 1)
  std::size_t count = 0;
};

/// 1 for each star of a block that is proven to meet itself in nothing but the corners and edges that its triangles
/// share. True is certain; false means nothing. [docs/mathematics.md, "Stars"]
std::array<unsigned char, StarBlock::capacity> prove_free(const StarBlock& stars, const PointRows& points);

}  // namespace stiv
