// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "detection/broad_phase/vertex_steps.hpp"
#include "stiv/detection/event.hpp"

namespace stiv {

/// Up to so many pairs, each of four vertices in the order of Event::vertices, as arrays over the pairs.
struct PairBlock {
  static constexpr std::size_t capacity = 64;

  std::array<std::array<Index, capacity>, 4> vertices{};
  std::size_t count = 0;

  void add(const std::array<Index, 4>& pair) {
    for (std::size_t k = 0; k < 4; ++k) vertices[k][count] = pair[k];
    ++count;
  }
  std::array<Index, 4> vertices_of(std::size_t k) const {
    return {vertices[0][k], vertices[1][k], vertices[2][k], vertices[3][k]};
  }
};

/// 1 or 0 for each pair of a block.
using PairFlags = std::array<unsigned char, PairBlock::capacity>;

/// 1 for each pair that a plane shows apart for the whole step, by more than `separation` and all rounding: a quick
/// answer for most of them.
void find_apart(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                PairFlags& apart);

}  // namespace stiv
