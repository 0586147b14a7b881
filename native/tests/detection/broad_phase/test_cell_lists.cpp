// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>
#include <set>

#include "detection/broad_phase/cell_lists.hpp"

using namespace stiv;

namespace {

std::vector<Bounds> boxes_of_sizes(int count, double smallest, double largest, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1), power(std::log(smallest), std::log(largest));
  std::vector<Bounds> boxes;
  for (int k = 0; k < count; ++k) {
    Bounds box = Bounds::empty();
    box.include(Vector3(unit(random), unit(random), unit(random)), std::exp(power(random)));
    boxes.push_back(box);
  }
  return boxes;
}

/// Pairs that meet in the first cell that they have in common, each repeated as often as it is found.
std::multiset<std::pair<Index, Index>> pairs_by_cell(const std::vector<Bounds>& boxes) {
  const CellLists lists(fitting_cells(boxes), boxes);
  std::multiset<std::pair<Index, Index>> pairs;
  for (Index number = 0; number < lists.bucket_count(); ++number)
    for (const CellEntry& a : lists.bucket(number))
      for (const CellEntry& b : lists.bucket(number))
        if (a.primitive < b.primitive && a.cell == b.cell && overlap(a.box, b.box) &&
            a.cell == first_common_cell(a.first_cell, b.first_cell))
          pairs.emplace(a.primitive, b.primitive);
  return pairs;
}

}  // namespace

TEST_CASE("cell lists: every pair of boxes that overlap meets once, whatever their sizes") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::vector<Bounds> boxes = boxes_of_sizes(300, 1e-3, seed == 3 ? 2.0 : 0.3, seed);
    std::multiset<std::pair<Index, Index>> expected;
    for (Index i = 0; i < 300; ++i)
      for (Index j = i + 1; j < 300; ++j)
        if (overlap(boxes[static_cast<std::size_t>(i)], boxes[static_cast<std::size_t>(j)])) expected.emplace(i, j);
    CHECK(expected.size() > 20);
    CHECK(pairs_by_cell(boxes) == expected);
  }
}

TEST_CASE("cell lists: one box over all others does not fill the memory") {
  std::vector<Bounds> boxes = boxes_of_sizes(5000, 1e-6, 2e-6, 4);
  boxes.push_back(boxes_of_sizes(1, 1, 1, 5)[0]);
  const CellLists lists(fitting_cells(boxes), boxes);
  std::size_t entries = 0;
  for (Index number = 0; number < lists.bucket_count(); ++number) entries += lists.bucket(number).size();
  CHECK(entries >= boxes.size());
  CHECK(entries <= 8 * boxes.size());
}

// Found by fuzzing: a loose vertex that moved far past faces without extent filled the memory.
TEST_CASE("cell lists: boxes that are entered besides those that the cells fit do not fill the memory either") {
  const std::vector<Bounds> faces = boxes_of_sizes(10, 1e-9, 2e-9, 6), vertices = boxes_of_sizes(1, 1, 1, 7);
  const CellLists lists(fitting_cells(faces, vertices), vertices);
  std::size_t entries = 0;
  for (Index number = 0; number < lists.bucket_count(); ++number) entries += lists.bucket(number).size();
  CHECK(entries >= 1);
  CHECK(entries <= 8 * 11);
}

TEST_CASE("cell lists: none, points in one place, and boxes beyond single precision") {
  CHECK(pairs_by_cell({}).empty());
  Bounds point = Bounds::empty();
  point.include(Vector3(1, 2, 3), 0);
  CHECK(pairs_by_cell({point, point, point}).size() == 3);
  Bounds huge = Bounds::empty();
  huge.include(Vector3::Zero(), 1e60);
  CHECK(pairs_by_cell({huge, huge, point}).size() == 3);
}
