// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/vertex_steps.hpp"

namespace stiv {

namespace {

constexpr Index chunk_size = 2048;

}  // namespace

void VertexSteps::take(const PositionsView& start, const PositionsView& end, Index row, Index vertex) {
  const double* const from = start.data() + 3 * static_cast<std::ptrdiff_t>(row);
  const double* const to = end.data() + 3 * static_cast<std::ptrdiff_t>(row);
  rows_[vertex] = {{from[0], from[1], from[2], 0}, {to[0], to[1], to[2], 0}};
}

void VertexSteps::update_first(Index count, const PositionsView& start, const PositionsView& end,
                               const Execution& execution) {
  rows_.resize(static_cast<std::size_t>(start.rows()));
  execution.for_chunks(count, chunk_size, [&](Index first, Index last, Index) {
    for (Index vertex = first; vertex < last; ++vertex) take(start, end, vertex, vertex);
  });
}

void VertexSteps::update(const PositionsView& start, const PositionsView& end, const std::vector<Index>& vertices,
                         const Execution& execution) {
  execution.for_chunks(static_cast<Index>(vertices.size()), chunk_size, [&](Index first, Index last, Index) {
    for (Index k = first; k < last; ++k) {
      const Index vertex = vertices[k];
      take(start, end, vertex, vertex);
    }
  });
}

void VertexSteps::update_rows(const PositionsView& start, const PositionsView& end, const std::vector<Index>& vertices,
                              Index vertex_count, const Execution& execution) {
  rows_.resize(static_cast<std::size_t>(vertex_count));
  execution.for_chunks(static_cast<Index>(vertices.size()), chunk_size, [&](Index first, Index last, Index) {
    for (Index k = first; k < last; ++k) take(start, end, k, vertices[k]);
  });
}

}  // namespace stiv
