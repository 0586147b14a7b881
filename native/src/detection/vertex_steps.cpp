// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/vertex_steps.hpp"

namespace stiv {

namespace {

constexpr Index chunk_size = 8192;

}  // namespace

void VertexSteps::take(const PositionsView& start, const PositionsView& end, Index vertex) {
  const double* const from = start.data() + 3 * static_cast<std::ptrdiff_t>(vertex);
  const double* const to = end.data() + 3 * static_cast<std::ptrdiff_t>(vertex);
  rows_[static_cast<std::size_t>(vertex)] = {{from[0], from[1], from[2], 0}, {to[0], to[1], to[2], 0}};
}

void VertexSteps::update(const PositionsView& start, const PositionsView& end, const Execution& execution) {
  const auto count = static_cast<Index>(start.rows());
  rows_.resize(static_cast<std::size_t>(count));
  execution.for_chunks(count, chunk_size, [&](Index first, Index last, Index) {
    for (Index vertex = first; vertex < last; ++vertex) take(start, end, vertex);
  });
}

void VertexSteps::update(const PositionsView& start, const PositionsView& end, const std::vector<Index>& vertices,
                         const Execution& execution) {
  execution.for_chunks(static_cast<Index>(vertices.size()), chunk_size, [&](Index first, Index last, Index) {
    for (Index k = first; k < last; ++k) take(start, end, vertices[static_cast<std::size_t>(k)]);
  });
}

}  // namespace stiv
