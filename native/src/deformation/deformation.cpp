// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/deformation.hpp"

#include "position_rows.hpp"
#include "stiv/coordinate_range.hpp"

namespace stiv {

namespace {

constexpr Index covectors_per_chunk = 16;
constexpr Index rows_per_chunk = 4096;

}  // namespace

Positions Deformation::surface_in_range(const Controls& p, const Execution& execution) const {
  Positions q = surface(p, execution);
  execution.for_chunks(static_cast<Index>(q.rows()), rows_per_chunk,
                       [&](Index begin, Index end, Index) { flush_below_range(q.middleRows(begin, end - begin)); });
  return q;
}

void Deformation::put_surface(const Controls& p, std::span<const Index> rows, Positions& q,
                              const Execution& execution) const {
  const Positions placed = surface(p, execution);
  execution.for_chunks(static_cast<Index>(placed.rows()), rows_per_chunk, [&](Index begin, Index end, Index) {
    for (Index row = begin; row < end; ++row) q.row(rows.empty() ? row : rows[at(row)]) = placed.row(row);
  });
}

Positions Deformation::surface_rows(const Controls& p, std::span<const Index> vertices,
                                    const Execution& execution) const {
  return rows_of(surface(p, execution), vertices);
}

std::vector<SparseField> Deformation::pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                                    const Execution& execution) const {
  std::vector<SparseField> pulled(g.size());
  execution.for_chunks(static_cast<Index>(g.size()), covectors_per_chunk, [&](Index begin, Index end, Index) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      pulled[k] = pull_back(p, g[k]);
  });
  return pulled;
}

}  // namespace stiv
