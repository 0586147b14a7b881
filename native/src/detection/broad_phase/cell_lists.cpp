// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/cell_lists.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace stiv {

namespace {

constexpr double most_cells_along_an_axis = 1 << 20;
constexpr double most_cells_of_a_box = 8;  // on average

double finite(float value) {
  constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
  return std::clamp(static_cast<double>(value), -largest, largest);
}

double largest_side(const Bounds& box) {
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) side = std::max(side, finite(box.high[axis]) - finite(box.low[axis]));
  return side;
}

double cells_reached(const Cells& cells, const std::vector<Bounds>& boxes) {
  double sum = 0;
  for (const Bounds& box : boxes) {
    const Cell low = cells.at(box.low), high = cells.at(box.high);
    double count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) count *= high[axis] - low[axis] + 1;
    sum += count;
  }
  return sum;
}

template <class Work>
void for_cells_of(const Cells& cells, const Bounds& box, const Work& work) {
  const Cell low = cells.at(box.low), high = cells.at(box.high);
  for (std::int32_t x = low[0]; x <= high[0]; ++x)
    for (std::int32_t y = low[1]; y <= high[1]; ++y)
      for (std::int32_t z = low[2]; z <= high[2]; ++z) work(Cell{x, y, z}, low);
}

}  // namespace

Cell Cells::at(const std::array<float, 3>& point) const {
  Cell cell;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place = std::floor((finite(point[axis]) - origin[static_cast<Index>(axis)]) / size);
    cell[axis] = static_cast<std::int32_t>(std::clamp(place, 0.0, 2 * most_cells_along_an_axis));
  }
  return cell;
}

Cells fitting_cells(const std::vector<Bounds>& boxes, const std::vector<Bounds>& others) {
  Cells cells;
  if (boxes.empty()) return cells;
  Bounds all = Bounds::empty();
  double sum = 0;
  for (const Bounds& box : boxes) {
    all.include(box);
    sum += largest_side(box);
  }
  for (const Bounds& box : others) all.include(box);
  for (std::size_t axis = 0; axis < 3; ++axis) cells.origin[static_cast<Index>(axis)] = finite(all.low[axis]);
  cells.size = std::max(sum / static_cast<double>(boxes.size()), largest_side(all) / most_cells_along_an_axis);
  if (!(cells.size > 0)) cells.size = 1;
  const double most = most_cells_of_a_box * static_cast<double>(boxes.size() + others.size());
  while (cells_reached(cells, boxes) + cells_reached(cells, others) > most) cells.size *= 2;
  return cells;
}

CellLists::CellLists(const Cells& cells, const std::vector<Bounds>& boxes)
    : start_(std::bit_ceil(boxes.size() + 1) + 1, 0) {
  for (const Bounds& box : boxes)
    for_cells_of(cells, box, [&](const Cell& cell, const Cell&) { ++start_[number_of(cell)]; });
  std::size_t sum = 0;
  for (std::size_t& count : start_) count = sum += count;
  entries_.resize(sum);
  // From last to first: so each start moves back to the first entry of its bucket, and entries are in order.
  for (std::size_t primitive = boxes.size(); primitive-- > 0;)
    for_cells_of(cells, boxes[primitive], [&](const Cell& cell, const Cell& first) {
      entries_[--start_[number_of(cell)]] = {cell, first, static_cast<Index>(primitive), boxes[primitive]};
    });
}

std::span<const CellEntry> CellLists::bucket(Index number) const {
  const auto at = static_cast<std::size_t>(number);
  return {entries_.data() + start_[at], start_[at + 1] - start_[at]};
}

Index CellLists::number_of(const Cell& cell) const {
  const auto hash = static_cast<std::uint32_t>(cell[0]) * 73856093U ^ static_cast<std::uint32_t>(cell[1]) * 19349663U ^
                    static_cast<std::uint32_t>(cell[2]) * 83492791U;
  return static_cast<Index>(hash & (start_.size() - 2));
}

}  // namespace stiv
