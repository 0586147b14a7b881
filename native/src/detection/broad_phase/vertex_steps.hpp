// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "large_array.hpp"
#include "stiv/execution.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Start and end of a vertex, in one cache line.
struct alignas(64) VertexStep {
  double start[4];  ///< x, y, z, 0
  double end[4];
};

/// The step of all vertices, laid out for vector code. Memory is reused from step to step.
class VertexSteps {
 public:
  /// Sets the step of all vertices. Rows of `start` and `end` are positions, (N, 3).
  void update(const PositionsView& start, const PositionsView& end, const Execution& execution) {
    update_first(static_cast<Index>(start.rows()), start, end, execution);
  }
  /// The same for the first vertices.
  void update_first(Index count, const PositionsView& start, const PositionsView& end, const Execution& execution);
  /// Updates some vertices.
  void update(const PositionsView& start, const PositionsView& end, const std::vector<Index>& vertices,
              const Execution& execution);

  /// Sets the step of a vertex that rests.
  void update_one(Index vertex, const PositionsView& positions) { take(positions, positions, vertex, vertex); }

  /// Updates some vertices from their rows, (k, 3) each.
  void update_rows(const PositionsView& start, const PositionsView& end, const std::vector<Index>& vertices,
                   Index vertex_count, const Execution& execution);

  const VertexStep* data() const { return rows_.data(); }

 private:
  void take(const PositionsView& start, const PositionsView& end, Index row, Index vertex);

  LargeArray<VertexStep> rows_;
};

}  // namespace stiv
