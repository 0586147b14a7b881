// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "detection/broad_phase/bounds.hpp"

namespace stiv {

/// Number of a cell along each axis, from 0.
using Cell = std::array<std::int32_t, 3>;

/// The first cell that two boxes have in common, given that they overlap.
inline Cell first_common_cell(const Cell& a, const Cell& b) {
  return {std::max(a[0], b[0]), std::max(a[1], b[1]), std::max(a[2], b[2])};
}

/// Cubes of equal size that fill space.
struct Cells {
  Vector3 origin = Vector3::Zero();
  double size = 1;

  /// Cell of a point given in single precision; points beyond single precision count as its largest number.
  Cell at(const std::array<float, 3>& point) const;
};

/// Cells of the mean size of the boxes, or larger by powers of two until all boxes to be entered reach at most eight
/// cells each on average: large boxes among small ones must not fill the memory.
Cells fitting_cells(const std::vector<Bounds>& boxes, const std::vector<Bounds>& others = {});

/// One box in one of the cells that it reaches.
struct CellEntry {
  Cell cell, first_cell;  ///< `first_cell`: the first of the box
  Index primitive;
  Bounds box;
};

/// Boxes by cell: the entries of a cell are all in one bucket, whose number is a hash of the cell.
class CellLists {
 public:
  CellLists() = default;
  CellLists(const Cells& cells, const std::vector<Bounds>& boxes);

  Index bucket_count() const { return static_cast<Index>(start_.size()) - 1; }
  std::span<const CellEntry> bucket(Index number) const;
  std::span<const CellEntry> bucket_of(const Cell& cell) const { return bucket(number_of(cell)); }

 private:
  Index number_of(const Cell& cell) const;

  std::vector<std::size_t> start_{0};
  std::vector<CellEntry> entries_;
};

}  // namespace stiv
