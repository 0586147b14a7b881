// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/handle_map.hpp"

#include <algorithm>

#include "deformation/handles/handle_system.hpp"
#include "deformation/handles/truncated_map.hpp"

namespace stiv {

namespace {

/// Unit columns of the rows `first` to `first + count - 1` of `rows`; zero beyond.
ColumnBlock unit_columns(const std::vector<Index>& rows, Index first, Index count, Index size) {
  ColumnBlock unit = ColumnBlock::Zero(size, ColumnBlock::ColsAtCompileTime);
  for (Index k = 0; k < count; ++k) unit(rows[at(first + k)], k) = 1;
  return unit;
}

/// The common direction of all values of a field, up to rounding, or the three axes if there is none.
std::vector<Vector3> directions_of(const SparseField& field) {
  constexpr double rounding = 1e-14;
  Vector3 largest = Vector3::Zero();
  for (const Vector3& value : field.value)
    if (value.squaredNorm() > largest.squaredNorm()) largest = value;
  const Vector3 direction = largest.stableNormalized();
  const bool is_common = std::all_of(field.value.begin(), field.value.end(), [&](const Vector3& value) {
    return (value - direction.dot(value) * direction).norm() <= rounding * largest.norm();
  });
  if (is_common) return {direction};
  return {Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
}

/// A zero field with the rows 0 to `count` - 1.
SparseField whole_field(Index count) {
  SparseField field;
  for (Index k = 0; k < count; ++k) field.index.push_back(k);
  field.value.assign(static_cast<std::size_t>(count), Vector3::Zero());
  return field;
}

/// Boundaries of runs of fields that fit together into the columns of one block.
std::vector<std::size_t> runs_of(const std::vector<SparseField>& fields) {
  std::vector<std::size_t> begins{0};
  std::size_t used = 0;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const std::size_t columns = directions_of(fields[k]).size();
    if (used + columns > static_cast<std::size_t>(ColumnBlock::ColsAtCompileTime)) {
      begins.push_back(k);
      used = 0;
    }
    used += columns;
  }
  begins.push_back(fields.size());
  return begins;
}

}  // namespace

HandleMap::HandleMap(const HandleDefinition& definition, const Surface& mesh, const SymmetricMatrix& stiffness,
                     const HandleMapLimits& limits)
    : limits_(limits),
      partition_(handle_partition(definition, mesh)),
      handles_(definition.handles),
      hard_(definition.pull.size() == 0),
      drive_(drive_matrix(definition, partition_, stiffness)),
      factor_(std::make_unique<SparseFactor>(
          free_stiffness(definition, partition_, stiffness),
          "handles: the system is singular to rounding; add handles or fixed vertices")) {
  const std::vector<Index> driven = rows_in_use(drive_);
  needed_ = factor_->needed_for(driven);
  if (static_cast<double>(vertex_count()) * control_count() <= limits_.entries) {
    build_full_map();
    return;
  }
  if (static_cast<double>(driven.size()) * static_cast<double>(factor_->size()) <= limits_.entries) {
    cache_columns(driven);
    return;
  }
  constexpr double doubles_per_entry = 2;  // with its index
  const double products = static_cast<double>(vertex_count()) * control_count();
  truncated_ = truncated_map(*factor_, drive_, partition_, limits_.negligible,
                             std::min(limits_.density * products, limits_.entries / doubles_per_entry));
}

/// M d by a solve.
template <class Block>
Block HandleMap::product_by_solve(const Block& d) const {
  const Block free = factor_->solve(Block(drive_ * d));
  Block u = Block::Zero(vertex_count(), d.cols());
  for (Index k = 0; k < free.rows(); ++k) u.row(partition_.free[at(k)]) = free.row(k);
  if (hard_)
    for (Index k = 0; k < control_count(); ++k) u.row(handles_[at(k)]) = d.row(k);
  return u;
}

/// M'g by a solve.
template <class Block>
Block HandleMap::transposed_product_by_solve(const Block& g) const {
  Block free(static_cast<Index>(partition_.free.size()), g.cols());
  for (Index k = 0; k < free.rows(); ++k) free.row(k) = g.row(partition_.free[at(k)]);
  Block covector = drive_.transpose() * factor_->solve(free, needed_);
  if (hard_)
    for (Index k = 0; k < control_count(); ++k) covector.row(k) += g.row(handles_[at(k)]);
  return covector;
}

void HandleMap::build_full_map() {
  constexpr Index width = ColumnBlock::ColsAtCompileTime;
  full_.resize(vertex_count(), control_count());
  for (Index first = 0; first < control_count(); first += width) {
    const Index count = std::min(width, control_count() - first);
    ColumnBlock unit = ColumnBlock::Zero(control_count(), width);
    for (Index k = 0; k < count; ++k) unit(first + k, k) = 1;
    full_.middleCols(first, count) = product_by_solve(unit).leftCols(count);
  }
}

/// Adjacent handles drive few rows, those along the boundary of the patch. M'g = D' K^-1 g reads only these rows, so
/// with their columns of K^-1 cached, a contact costs a few products.
void HandleMap::cache_columns(const std::vector<Index>& driven) {
  constexpr Index width = ColumnBlock::ColsAtCompileTime;
  const auto count = static_cast<Index>(driven.size());
  cached_columns_.resize(factor_->size(), count);
  for (Index first = 0; first < count; first += width) {
    const Index some = std::min(width, count - first);
    cached_columns_.middleCols(first, some) =
        factor_->solve(unit_columns(driven, first, some, factor_->size())).leftCols(some);
  }
  cached_drive_ = selected_rows(drive_, driven);
}

/// M'g from the cached columns of K^-1.
Controls HandleMap::pull_back_cached(const SparseField& g) const {
  Positions driven = Positions::Zero(cached_drive_.rows(), 3), held = Positions::Zero(control_count(), 3);
  for (std::size_t k = 0; k < g.index.size(); ++k) {
    const auto vertex = static_cast<std::size_t>(g.index[k]);
    if (const Index place = partition_.place[vertex]; place >= 0)
      driven += cached_columns_.row(place).transpose() * g.value[k].transpose();
    else if (const Index control = partition_.control[vertex]; control >= 0)
      held.row(control) += g.value[k];
  }
  return cached_drive_.transpose() * driven + held;
}

/// A product reads M once, in order. A solve reads L twice, out of order: four times the cost for each entry.
bool HandleMap::product_is_cheaper() const {
  return is_full() && static_cast<double>(full_.size()) < 4.0 * factor_->entries();
}

Positions HandleMap::follow(const Controls& d) const {
  if (!product_is_cheaper()) return product_by_solve(d);
  Positions u(vertex_count(), 3);
  for (Index row = 0; row < u.rows(); ++row) {
    Vector3 sum = Vector3::Zero();
    const double* weight = full_.data() + static_cast<std::ptrdiff_t>(row) * full_.cols();
    for (Index k = 0; k < control_count(); ++k) sum += weight[k] * d.row(k).transpose();
    u.row(row) = sum;
  }
  return u;
}

/// M'g of several fields by one solve, with a column for each of their directions.
template <class Block>
void HandleMap::pull_by_solve(const SparseField* g, std::size_t count, SparseField* covectors) const {
  Block right = Block::Zero(vertex_count(), Block::ColsAtCompileTime);
  std::vector<std::vector<Vector3>> directions;
  Index column = 0;
  for (std::size_t field = 0; field < count; ++field)
    for (const Vector3& direction : directions.emplace_back(directions_of(g[field]))) {
      for (std::size_t k = 0; k < g[field].index.size(); ++k)
        right(g[field].index[k], column) = direction.dot(g[field].value[k]);
      ++column;
    }
  const Block left = transposed_product_by_solve(right);
  column = 0;
  for (std::size_t field = 0; field < count; ++field) {
    covectors[field] = whole_field(control_count());
    for (const Vector3& direction : directions[field]) {
      for (Index k = 0; k < control_count(); ++k) covectors[field].value[at(k)] += left(k, column) * direction;
      ++column;
    }
  }
}

SparseField HandleMap::pull_back(const SparseField& g) const {
  if (is_truncated()) return stiv::pull_back(*truncated_, g);
  SparseField covector = whole_field(control_count());
  if (!is_full() && !has_cached_columns()) {
    pull_by_solve<Positions>(&g, 1, &covector);
    return covector;
  }
  Controls sum = Controls::Zero(control_count(), 3);
  if (is_full())
    for (std::size_t k = 0; k < g.index.size(); ++k) sum += full_.row(g.index[k]).transpose() * g.value[k].transpose();
  else
    sum = pull_back_cached(g);
  for (Index k = 0; k < control_count(); ++k) covector.value[at(k)] = sum.row(k);
  return covector;
}

std::vector<SparseField> HandleMap::pull_back_all(const std::vector<SparseField>& g, const Execution& execution) const {
  std::vector<SparseField> covectors(g.size());
  if (pulls_back_by_products()) {
    constexpr Index products_per_chunk = 16;
    execution.for_chunks(static_cast<Index>(g.size()), products_per_chunk, [&](Index begin, Index end, Index) {
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
        covectors[k] = pull_back(g[k]);
    });
    return covectors;
  }
  const std::vector<std::size_t> runs = runs_of(g);
  execution.for_chunks(static_cast<Index>(runs.size()) - 1, 1, [&](Index run, Index, Index) {
    const std::size_t begin = runs[at(run)], end = runs[static_cast<std::size_t>(run) + 1];
    if (end - begin == 1)
      covectors[begin] = pull_back(g[begin]);
    else
      pull_by_solve<ColumnBlock>(&g[begin], end - begin, &covectors[begin]);
  });
  return covectors;
}

Positions HandleMap::solve(const Positions& rhs) const {
  Positions free(static_cast<Index>(partition_.free.size()), 3);
  for (Index k = 0; k < free.rows(); ++k) free.row(k) = rhs.row(partition_.free[at(k)]);
  free = factor_->solve(free);
  Positions u = Positions::Zero(vertex_count(), 3);
  for (Index k = 0; k < free.rows(); ++k) u.row(partition_.free[at(k)]) = free.row(k);
  return u;
}

std::vector<Index> HandleMap::support(Index control) const {
  const auto handle = static_cast<std::size_t>(handles_[at(control)]);
  const bool drives = drive_.outerIndexPtr()[control + 1] > drive_.outerIndexPtr()[control];
  std::vector<Index> vertices;
  if (drives)
    for (const Index vertex : partition_.free)
      if (partition_.component[at(vertex)] == partition_.component[handle]) vertices.push_back(vertex);
  if (hard_) vertices.insert(std::lower_bound(vertices.begin(), vertices.end(), handle), static_cast<Index>(handle));
  return vertices;
}

ColumnBlock HandleMap::gram_product(const ColumnBlock& d, const WeightMatrix* surface_gram) const {
  const ColumnBlock u = product_by_solve(d);
  return transposed_product_by_solve(surface_gram == nullptr ? u : ColumnBlock(*surface_gram * u));
}

}  // namespace stiv
