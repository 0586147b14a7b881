// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/truncated_map.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "deformation/metric/decaying_solver.hpp"

namespace stiv {

namespace {

constexpr Index width = ColumnBlock::ColsAtCompileTime;

using Triplets = std::vector<Eigen::Triplet<double, Index>>;

/// Controls with entries in `drive`, ordered so that neighboring handles are close to each other.
std::vector<Index> driving_controls(const SparseFactor& factor, const SymmetricMatrix& drive) {
  std::vector<std::pair<Index, Index>> places;
  for (Index control = 0; control < drive.cols(); ++control)
    if (const SymmetricMatrix::InnerIterator first(drive, control); first)
      places.emplace_back(factor.place(static_cast<Index>(first.row())), control);
  std::sort(places.begin(), places.end());
  std::vector<Index> controls;
  for (const auto& [place, control] : places) controls.push_back(control);
  return controls;
}

std::vector<BlockRow> driven_rows(const SymmetricMatrix& drive, std::span<const Index> controls) {
  std::vector<BlockRow> rows;
  for (std::size_t lane = 0; lane < controls.size(); ++lane)
    for (SymmetricMatrix::InnerIterator entry(drive, controls[lane]); entry; ++entry) {
      BlockRow& row = rows.emplace_back();
      row.row = static_cast<Index>(entry.row());
      row.values.setZero();
      row.values[static_cast<Index>(lane)] = entry.value();
    }
  return rows;
}

/// Columns of M of up to sixteen controls.
void add_columns(DecayingSolver& solver, const SymmetricMatrix& drive, const HandlePartition& partition,
                 std::span<const Index> controls, Triplets& entries) {
  for (const BlockRow& row : solver.solve(driven_rows(drive, controls)))
    for (std::size_t lane = 0; lane < controls.size(); ++lane)
      if (const double value = row.values[static_cast<Index>(lane)]; value != 0)
        entries.emplace_back(partition.free[at(row.row)], controls[lane], value);
}

/// Hard handles follow their controls.
Triplets held_entries(const HandlePartition& partition) {
  Triplets entries;
  for (std::size_t vertex = 0; vertex < partition.control.size(); ++vertex)
    if (partition.control[vertex] >= 0 && partition.place[vertex] < 0)
      entries.emplace_back(static_cast<Index>(vertex), partition.control[vertex], 1.0);
  return entries;
}

/// Adds factor M_ik M_jk for each control k.
void add_products(const WeightMatrix& map, Index i, Index j, double factor, Eigen::VectorXd& sums) {
  WeightMatrix::InnerIterator a(map, i), b(map, j);
  while (a && b) {
    if (a.col() == b.col()) sums[a.col()] += factor * a.value() * b.value();
    const bool advances_a = a.col() <= b.col(), advances_b = b.col() <= a.col();
    if (advances_a) ++a;
    if (advances_b) ++b;
  }
}

}  // namespace

std::optional<WeightMatrix> truncated_map(const SparseFactor& factor, const SymmetricMatrix& drive,
                                          const HandlePartition& partition, double negligible, double limit) {
  constexpr Index passes = 8;  // the first one, over the whole mesh, predicts the number of entries
  const std::vector<Index> controls = driving_controls(factor, drive);
  const auto count = static_cast<Index>(controls.size());
  DecayingSolver solver(factor, negligible);
  Triplets entries = held_entries(partition);
  Index done = 0;
  for (Index pass = 0; pass < passes; ++pass) {
    for (Index first = width * pass; first < count; first += width * passes) {
      const Index lanes = std::min(width, count - first);
      add_columns(solver, drive, partition, {controls.data() + first, at(lanes)}, entries);
      done += lanes;
      if (static_cast<double>(entries.size()) > limit) return std::nullopt;
    }
    if (static_cast<double>(entries.size()) * count > limit * done) return std::nullopt;
  }
  WeightMatrix map(static_cast<Index>(partition.place.size()), static_cast<Index>(drive.cols()));
  map.setFromTriplets(entries.begin(), entries.end());
  return map;
}

SparseField pull_back(const WeightMatrix& map, const SparseField& g) {
  Controls sum = Controls::Zero(map.cols(), 3);
  std::vector<unsigned char> reached(at(map.cols()), 0);
  for (std::size_t k = 0; k < g.index.size(); ++k)
    for (WeightMatrix::InnerIterator entry(map, g.index[k]); entry; ++entry) {
      sum.row(entry.col()) += entry.value() * g.value[k].transpose();
      reached[at(entry.col())] = 1;
    }
  SparseField pulled;
  for (Index control = 0; control < sum.rows(); ++control) {
    if (reached[at(control)] == 0) continue;
    pulled.index.push_back(control);
    pulled.value.emplace_back(sum.row(control));
  }
  return pulled;
}

Eigen::VectorXd gram_diagonal(const WeightMatrix& map, const WeightMatrix* surface_gram) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(map.cols());
  for (Index row = 0; row < map.rows(); ++row) {
    if (surface_gram == nullptr) {
      add_products(map, row, row, 1, sums);
      continue;
    }
    for (WeightMatrix::InnerIterator entry(*surface_gram, row); entry; ++entry)
      add_products(map, row, static_cast<Index>(entry.col()), entry.value(), sums);
  }
  return sums;
}

}  // namespace stiv
