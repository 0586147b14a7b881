// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/deformation.hpp"

#include "position_rows.hpp"
#include "stiv/coordinate_range.hpp"

namespace stiv {

namespace {

constexpr Index covectors_per_chunk = 16;

}  // namespace

Positions Deformation::surface_in_range(const Controls& p, const Execution& execution) const {
  Positions q = surface(p, execution);
  flush_below_range(q);
  return q;
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
