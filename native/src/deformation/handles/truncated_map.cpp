// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/truncated_map.hpp"

#include <algorithm>

#include "deformation/metric/decaying_solver.hpp"

namespace stiv {

namespace {

constexpr Index width = ColumnBlock::ColsAtCompileTime;

using Triplets = std::vector<Eigen::Triplet<double, Index>>;

/// Controls that drive something, those of neighbouring handles side by side.
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

std::vector<BlockRow> driven_rows(const SymmetricMatrix& drive, const Index* controls, Index count) {
  std::vector<BlockRow> rows;
  for (Index lane = 0; lane < count; ++lane)
    for (SymmetricMatrix::InnerIterator entry(drive, controls[lane]); entry; ++entry) {
      BlockRow& row = rows.emplace_back();
      row.row = static_cast<Index>(entry.row());
      row.values.setZero();
      row.values[lane] = entry.value();
    }
  return rows;
}

/// Vertices that are hard handles follow theirs.
Triplets held_entries(const HandlePartition& partition) {
  Triplets entries;
  for (std::size_t vertex = 0; vertex < partition.control.size(); ++vertex)
    if (partition.control[vertex] >= 0 && partition.place[vertex] < 0)
      entries.emplace_back(static_cast<Index>(vertex), partition.control[vertex], 1.0);
  return entries;
}

/// (G M)_ik M_jk summed over the pairs i, j of one entry of G: rows are ascending.
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
  const std::vector<Index> controls = driving_controls(factor, drive);
  const auto count = static_cast<Index>(controls.size());
  DecayingSolver solver(factor, negligible);
  Triplets entries = held_entries(partition);
  for (Index first = 0; first < count; first += width) {
    const Index* const some = controls.data() + first;
    const Index lanes = std::min(width, count - first);
    for (const BlockRow& row : solver.solve(driven_rows(drive, some, lanes)))
      for (Index lane = 0; lane < lanes; ++lane)
        if (row.values[lane] != 0)
          entries.emplace_back(partition.free[static_cast<std::size_t>(row.row)], some[lane], row.values[lane]);
    if (static_cast<double>(entries.size()) > limit) return std::nullopt;
  }
  WeightMatrix map(static_cast<Index>(partition.place.size()), static_cast<Index>(drive.cols()));
  map.setFromTriplets(entries.begin(), entries.end());
  return map;
}

SparseField pull_back(const WeightMatrix& map, const SparseField& g) {
  Controls sum = Controls::Zero(map.cols(), 3);
  std::vector<unsigned char> reached(static_cast<std::size_t>(map.cols()), 0);
  for (std::size_t k = 0; k < g.index.size(); ++k)
    for (WeightMatrix::InnerIterator entry(map, g.index[k]); entry; ++entry) {
      sum.row(entry.col()) += entry.value() * g.value[k].transpose();
      reached[static_cast<std::size_t>(entry.col())] = 1;
    }
  SparseField pulled;
  for (Index control = 0; control < sum.rows(); ++control) {
    if (reached[static_cast<std::size_t>(control)] == 0) continue;
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
