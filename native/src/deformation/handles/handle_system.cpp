// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/handle_system.hpp"

#include <algorithm>

namespace stiv {

namespace {

using Triplets = std::vector<Eigen::Triplet<double, Index>>;

SymmetricMatrix matrix_of(const Triplets& entries, std::size_t rows, std::size_t columns) {
  SymmetricMatrix matrix(static_cast<Index>(rows), static_cast<Index>(columns));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

SymmetricMatrix free_stiffness(const HandleDefinition& definition, const HandlePartition& partition,
                               const SymmetricMatrix& stiffness) {
  Triplets entries;
  for (const Index vertex : partition.free)
    for (SymmetricMatrix::InnerIterator entry(stiffness, vertex); entry; ++entry)
      if (const Index row = partition.place[at(entry.row())]; row >= 0)
        entries.emplace_back(row, partition.place[at(vertex)], entry.value());
  for (Index k = 0; k < definition.pull.size(); ++k) {
    const Index place = partition.place[at(definition.handles[at(k)])];
    entries.emplace_back(place, place, definition.pull[k]);
  }
  return matrix_of(entries, partition.free.size(), partition.free.size());
}

SymmetricMatrix drive_matrix(const HandleDefinition& definition, const HandlePartition& partition,
                             const SymmetricMatrix& stiffness) {
  Triplets entries;
  for (std::size_t k = 0; k < definition.handles.size(); ++k) {
    const Index handle = definition.handles[k], control = static_cast<Index>(k);
    const Index place = partition.place[at(handle)];
    if (place >= 0) {
      entries.emplace_back(place, control, definition.pull[control]);
      continue;
    }
    for (SymmetricMatrix::InnerIterator entry(stiffness, handle); entry; ++entry)
      if (const Index row = partition.place[at(entry.row())]; row >= 0)
        entries.emplace_back(row, control, -entry.value());
  }
  return matrix_of(entries, partition.free.size(), definition.handles.size());
}

std::vector<Index> rows_in_use(const SymmetricMatrix& matrix) {
  std::vector<unsigned char> used(static_cast<std::size_t>(matrix.rows()), 0);
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (SymmetricMatrix::InnerIterator entry(matrix, column); entry; ++entry) used[at(entry.row())] = 1;
  std::vector<Index> rows;
  for (Index row = 0; row < matrix.rows(); ++row)
    if (used[at(row)] != 0) rows.push_back(row);
  return rows;
}

SymmetricMatrix selected_rows(const SymmetricMatrix& matrix, const std::vector<Index>& rows) {
  Triplets entries;
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (SymmetricMatrix::InnerIterator entry(matrix, column); entry; ++entry)
      if (const auto found = std::lower_bound(rows.begin(), rows.end(), entry.row());
          found != rows.end() && *found == entry.row())
        entries.emplace_back(static_cast<Index>(found - rows.begin()), column, entry.value());
  return matrix_of(entries, rows.size(), static_cast<std::size_t>(matrix.cols()));
}

}  // namespace stiv
