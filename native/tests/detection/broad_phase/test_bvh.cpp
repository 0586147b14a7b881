// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "detection/broad_phase/bvh.hpp"

using namespace stiv;

namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

std::vector<Bounds> random_boxes(int count, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Bounds> boxes;
  for (int k = 0; k < count; ++k) {
    const Vector3 low(unit(random), unit(random), unit(random));
    const Vector3 high = low + size * Vector3(unit(random), unit(random), unit(random));
    Bounds box = Bounds::empty();
    box.include(low, 0);
    box.include(high, 0);
    boxes.push_back(box);
  }
  return boxes;
}

/// `keep(i, j)` of the pairs that overlap; within one list if both are the same.
template <class Keep>
Pairs expected_pairs(const std::vector<Bounds>& a, const std::vector<Bounds>& b, const Keep& keep) {
  Pairs pairs;
  for (Index i = 0; i < static_cast<Index>(a.size()); ++i)
    for (Index j = &a == &b ? i + 1 : 0; j < static_cast<Index>(b.size()); ++j)
      if (overlap(a[static_cast<std::size_t>(i)], b[static_cast<std::size_t>(j)]) && keep(i, j))
        pairs.emplace_back(i, j);
  return pairs;
}

Pairs sorted(Pairs pairs, bool unordered) {
  if (unordered)
    for (auto& [i, j] : pairs)
      if (i > j) std::swap(i, j);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

const auto all = [](Index, Index) { return true; };

}  // namespace

TEST_CASE("bvh: pairs within a tree and between trees are those of all boxes compared") {
  const Execution execution(2);
  for (const int count : {0, 1, 7, 8, 9, 64, 65, 700}) {
    const std::vector<Bounds> a = random_boxes(count, 0.2, 1), b = random_boxes(count / 2 + 1, 0.1, 2);
    const Bvh tree(a), other(b);
    CHECK(tree.size() == count);
    CHECK(sorted(Bvh::overlapping_pairs(tree, execution), true) == expected_pairs(a, a, all));
    CHECK(sorted(Bvh::overlapping_pairs(tree, other, execution), false) == expected_pairs(a, b, all));
  }
}

TEST_CASE("bvh: refitted to boxes that moved, with some of them active") {
  const Execution execution(1);
  const std::vector<Bounds> moved = random_boxes(500, 0.2, 4);
  std::vector<unsigned char> active(500, 0);
  for (std::size_t k = 0; k < 500; k += 50) active[k] = 1;
  Bvh tree(random_boxes(500, 0.2, 3));
  tree.refit(moved, active);
  const auto any_active = [&](Index i, Index j) {
    return (active[static_cast<std::size_t>(i)] | active[static_cast<std::size_t>(j)]) != 0;
  };
  CHECK(sorted(Bvh::overlapping_pairs(tree, execution), true) == expected_pairs(moved, moved, any_active));
}

TEST_CASE("bvh: groups that do not meet are left out") {
  const std::vector<Bounds> boxes = random_boxes(400, 0.2, 5);
  std::vector<Index> groups;
  for (Index k = 0; k < 400; ++k) groups.push_back(k % 3);
  const GroupRelations relations{GroupTable(3, {0, 1, 1, 1, 1, 0, 1, 0, 1}), {}};
  const Bvh tree(boxes, groups);
  PairBuffer found;
  for (const Bvh::Task& task : tree.tasks(tree, relations)) tree.overlaps(task, tree, relations, found);
  Pairs pairs;
  for (std::size_t k = 0; k < found.count; ++k) pairs.emplace_back(found.first[k], found.second[k]);
  CHECK(sorted(pairs, true) ==
        expected_pairs(boxes, boxes, [&](Index i, Index j) { return relations.table.meet(i % 3, j % 3); }));
}

TEST_CASE("bvh: boxes in moving frames meet if they do at some time, and hardly any others") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  const std::vector<Bounds> boxes = random_boxes(600, 0.1, 8);
  std::vector<Index> groups;
  for (Index k = 0; k < 600; ++k) groups.push_back(k % 4);
  for (const double scale : {1e-5, 0.1, 3.0}) {
    std::vector<Vector3> motions;
    for (int k = 0; k < 4; ++k) motions.emplace_back(scale * Vector3(unit(random), unit(random), unit(random)));
    motions[2] = motions[0];
    const GroupRelations relations{{}, GroupFrames(motions, 8)};
    const Bvh tree(boxes, groups);
    PairBuffer found;
    for (const Bvh::Task& task : tree.tasks(tree, relations)) tree.overlaps(task, tree, relations, found);
    Pairs pairs;
    for (std::size_t k = 0; k < found.count; ++k) pairs.emplace_back(found.first[k], found.second[k]);
    pairs = sorted(pairs, true);
    CHECK(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end());
    const auto meet = [&](Index i, Index j, double tolerance) {
      const Bounds &a = boxes[static_cast<std::size_t>(i)], &b = boxes[static_cast<std::size_t>(j)];
      const Vector3 relative = motions[static_cast<std::size_t>(i % 4)] - motions[static_cast<std::size_t>(j % 4)];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double along = relative[static_cast<Index>(axis)];
        if (double(a.low[axis]) + std::min(0.0, along) > double(b.high[axis]) + tolerance ||
            double(b.low[axis]) > double(a.high[axis]) + std::max(0.0, along) + tolerance)
          return false;
      }
      return true;
    };
    std::size_t wanted = 0, most = 0;
    for (Index i = 0; i < 600; ++i)
      for (Index j = i + 1; j < 600; ++j) {
        most += meet(i, j, 1e-4);
        if (!meet(i, j, 0)) continue;
        ++wanted;
        CHECK(std::binary_search(pairs.begin(), pairs.end(), std::pair(i, j)));
      }
    CHECK(wanted > 100);
    CHECK(pairs.size() <= most);
  }
}

TEST_CASE("bvh: groups that did not change keep their boxes") {
  std::vector<Bounds> boxes = random_boxes(500, 0.2, 10);
  const std::vector<Bounds> moved = random_boxes(500, 0.2, 11);
  std::vector<Index> groups;
  for (Index k = 0; k < 500; ++k) groups.push_back(k % 3);
  Bvh tree(boxes, groups);
  std::vector<PackedBox> vertices;
  std::vector<Index> corners;
  for (std::size_t k = 0; k < 500; ++k) {
    vertices.push_back(PackedBox::of(moved[k], true));
    corners.push_back(static_cast<Index>(k));
  }
  tree.refit_groups_corners({0, 1, 0}, tree.block_corners({corners.data(), 1}), vertices, Execution(2));
  for (std::size_t k = 1; k < 500; k += 3) boxes[k] = moved[k];
  CHECK(sorted(Bvh::overlapping_pairs(tree, Execution(1)), true) == expected_pairs(boxes, boxes, all));
}

TEST_CASE("bvh: after some vertices changed, all nodes are those of a complete refit") {
  constexpr Index vertices = 3000, faces = 5000;
  std::mt19937 random(12);
  std::uniform_int_distribution<Index> near(0, 20);
  std::vector<Index> rows;
  for (Index face = 0; face < faces; ++face)
    for (int k = 0; k < 3; ++k) rows.push_back((face * (vertices - 20) / faces + near(random)) % vertices);
  const auto packed = [](const std::vector<Bounds>& boxes) {
    std::vector<PackedBox> result;
    for (const Bounds& box : boxes) result.push_back(PackedBox::of(box, true));
    return result;
  };
  const std::vector<PackedBox> moved = packed(random_boxes(vertices, 0.1, 14));
  const NumberedPoints centres = centres_of(random_boxes(faces, 0.1, 15));
  const Execution execution(1);
  Bvh tree(centres, {}, {rows.data(), 3}, execution), whole = tree;
  std::vector<PackedBox> boxes = packed(random_boxes(vertices, 0.1, 13));
  tree.refit_corners(boxes, execution);
  for (const Index step : {1, 37, 400}) {
    std::vector<Index> changed;
    for (Index vertex = step; vertex < vertices; vertex += vertex % 3 == 0 ? 1 : step) changed.push_back(vertex);
    for (const Index vertex : changed) boxes[at(vertex)] = moved[at(vertex)];
    tree.refit_some_corners(changed, boxes);
    whole.refit_corners(boxes, execution);
    for (std::size_t level = 0; level < whole.levels().size(); ++level)
      for (std::size_t node = 0; node < whole.levels()[level].boxes.size(); ++node) {
        CHECK(tree.levels()[level].boxes[node].values == whole.levels()[level].boxes[node].values);
        const auto &planes = tree.levels()[level].nodes[node].planes,
                   &wanted = whole.levels()[level].nodes[node].planes;
        for (std::size_t plane = 0; plane < 7; ++plane)
          CHECK(std::equal(planes[plane], planes[plane] + Bvh::width, wanted[plane]));
      }
  }
}

TEST_CASE("bvh: the order of pairs does not depend on the number of threads") {
  const Bvh tree(random_boxes(3000, 0.05, 6));
  const Pairs expected = Bvh::overlapping_pairs(tree, Execution(1));
  CHECK(expected.size() > 300);
  for (const int threads : {2, 3}) CHECK(Bvh::overlapping_pairs(tree, Execution(threads)) == expected);
}

TEST_CASE("bvh: the tree does not depend on the number of threads") {
  const NumberedPoints centres = centres_of(random_boxes(20000, 0.05, 8));
  std::vector<Index> groups;
  for (Index k = 0; k < 20000; ++k) groups.push_back(k < 15000 ? 0 : 1);
  const Bvh tree(centres, groups, {}, Execution(1));
  for (const int threads : {2, 3}) CHECK(Bvh(centres, groups, {}, Execution(threads)).order() == tree.order());
}

TEST_CASE("bounds: single precision is rounded outward at all scales") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double scale : {1e-310, 1e-40, 1e-7, 1.0, 1e7, 1e38, 1e60})
    for (int trial = 0; trial < 200; ++trial) {
      const Vector3 point = scale * Vector3(unit(random), unit(random), unit(random));
      Bounds box = Bounds::empty();
      box.include(point, 0);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(static_cast<double>(box.low[axis]) <= point[static_cast<Index>(axis)]);
        CHECK(static_cast<double>(box.high[axis]) >= point[static_cast<Index>(axis)]);
      }
    }
}
