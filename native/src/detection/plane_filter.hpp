// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "stiv/detection/event.hpp"
#include "stiv/execution.hpp"

namespace stiv {

/// Where a vertex starts and ends, in one line of the cache.
struct alignas(64) VertexStep {
  double start[4];  ///< x, y, z, 0
  double end[4];
};

/// The step of all vertices, made for vector code to load. Keeps its memory from step to step.
class VertexSteps {
 public:
  /// Rows of `start` and `end` are positions, (N, 3).
  void update(const Positions& start, const Positions& end, const Execution& execution);

  const VertexStep* data() const { return rows_.data(); }

 private:
  std::vector<VertexStep> rows_;
};

/// Up to so many pairs, each of four vertices in the order of Event::vertices, as arrays over the pairs.
struct PairBlock {
  static constexpr std::size_t capacity = 64;

  std::array<std::array<Index, capacity>, 4> vertices{};
  std::size_t count = 0;

  void add(const std::array<Index, 4>& pair) {
    for (std::size_t k = 0; k < 4; ++k) vertices[k][count] = pair[k];
    ++count;
  }
};

/// 1 or 0 for each pair of a block.
using PairFlags = std::array<unsigned char, PairBlock::capacity>;

/// 1 for each pair that a plane shows apart for the whole step, by more than `separation` and all rounding: a quick
/// answer for most of them.
void find_apart(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                PairFlags& apart);

}  // namespace stiv
