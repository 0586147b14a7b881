// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "acceptance/intersection/point_rows.hpp"

namespace stiv {

/// Up to so many pairs of triangles, as arrays over the pairs.
struct TrianglePairs {
  static constexpr std::size_t capacity = 64;

  std::array<std::array<Index, capacity>, 6> corners{};  ///< three of the first, then three of the second
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

/// 1 for each pair that a plane separates strictly, beyond all rounding: across the line that joins the centres, in
/// parallel to one of the triangles, or upright on one over one of its edges. True is certain; false means nothing.
void find_separated(const TrianglePairs& pairs, const PointRows& points, TriangleFlags& separated);

}  // namespace stiv
