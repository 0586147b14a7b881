// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/deformation.hpp"

#include <algorithm>

#include "position_rows.hpp"
#include "stiv/coordinate_range.hpp"

namespace stiv {

namespace {

constexpr Index covectors_per_chunk = 16;
constexpr Index rows_per_chunk = 4096;
constexpr Index unit_covectors_at_once = 1024;

/// Adds a vertex that a unit motion of the control moves by `motion` along x.
void add_vertex(Influence& found, Index control, double motion, double distance) {
  if (!(motion > 0)) return;
  found.largest[control] = std::max(found.largest[control], motion);
  found.miss[control] = std::max(found.miss[control], distance);
}

/// One covector for each vertex.
void add_rows(const Deformation& deformation, const Controls& p, const Eigen::VectorXd& distances,
              const Execution& execution, Influence& found) {
  const auto count = static_cast<Index>(distances.size());
  for (Index begin = 0; begin < count; begin += unit_covectors_at_once) {
    const Index end = std::min(count, begin + unit_covectors_at_once);
    std::vector<SparseField> units;
    for (Index vertex = begin; vertex < end; ++vertex) units.push_back({{vertex}, {Vector3::UnitX()}});
    const std::vector<SparseField> rows = deformation.pull_back_all(p, units, execution);
    for (Index vertex = begin; vertex < end; ++vertex) {
      const SparseField& row = rows[at(vertex - begin)];
      for (std::size_t k = 0; k < row.index.size(); ++k)
        add_vertex(found, row.index[k], row.value[k].norm(), distances[vertex]);
    }
  }
}

/// Three motions for each control.
void add_columns(const Deformation& deformation, const Controls& p, const Eigen::VectorXd& distances,
                 const Execution& execution, Influence& found) {
  deformation.visit_columns(p, execution, [&](Index control, const Deformation::ControlColumns& columns) {
    for (Index vertex = 0; vertex < static_cast<Index>(distances.size()); ++vertex) {
      const Vector3 row(columns[0](vertex, 0), columns[1](vertex, 0), columns[2](vertex, 0));
      add_vertex(found, control, row.norm(), distances[vertex]);
    }
  });
}

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

void Deformation::visit_columns(const Controls& p, const Execution& execution,
                                const std::function<void(Index, const ControlColumns&)>& visit) const {
  execution.for_chunks(control_count(), 1, [&](Index control, Index, Index) {
    ControlColumns columns;
    for (int axis = 0; axis < 3; ++axis) {
      Controls unit = Controls::Zero(control_count(), 3);
      unit(control, axis) = 1;
      columns[at(axis)] = push_forward(p, unit);
    }
    visit(control, columns);
  });
}

Influence Deformation::influence(const Controls& p, const Eigen::VectorXd& distances,
                                 const Execution& execution) const {
  Influence found{Eigen::VectorXd::Zero(control_count()), Eigen::VectorXd::Zero(control_count())};
  (has_cheaper_columns() ? add_columns : add_rows)(*this, p, distances, execution, found);
  return found;
}

}  // namespace stiv
