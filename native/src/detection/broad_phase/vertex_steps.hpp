// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/execution.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Where a vertex starts and ends, in one line of the cache.
struct alignas(64) VertexStep {
  double start[4];  ///< x, y, z, 0
  double end[4];
};

/// The step of all vertices, made for vector code to load. Keeps its memory from step to step.
class VertexSteps {
 public:
  /// Takes all of a step. Rows of `start` and `end` are positions, (N, 3).
  void update(const PositionsView& start, const PositionsView& end, const Execution& execution);
  /// Takes what it is for some vertices.
  void update(const PositionsView& start, const PositionsView& end, const std::vector<Index>& vertices,
              const Execution& execution);

  /// Takes a step of which only the rows of some vertices are given, (k, 3) each; the others stay what they were.
  void update_rows(const PositionsView& start, const PositionsView& end, const std::vector<Index>& vertices,
                   Index vertex_count);

  const VertexStep* data() const { return rows_.data(); }

 private:
  void take(const PositionsView& start, const PositionsView& end, Index row, Index vertex);

  std::vector<VertexStep> rows_;
};

}  // namespace stiv
