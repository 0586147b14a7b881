// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <random>

#include "detection/broad_phase/block_order.hpp"
#include "detection/broad_phase/corner_order.hpp"
#include "detection/broad_phase/curve_order.hpp"
#include "stiv/execution.hpp"

using namespace stiv;

namespace {

constexpr Index vertex_count = 5000;

NumberedPoints random_points(Index count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  NumberedPoints points;
  for (Index k = 0; k < count; ++k) points.push_back({{unit(random), unit(random), unit(random)}, k});
  return points;
}

std::vector<Index> random_places() {
  std::vector<Index> places(static_cast<std::size_t>(vertex_count));
  std::iota(places.begin(), places.end(), 0);
  std::shuffle(places.begin(), places.end(), std::mt19937(7));
  return places;
}

std::vector<Index> random_rows(Index count, Index size) {
  std::mt19937 random(6);
  std::uniform_int_distribution<Index> vertex(0, vertex_count - 1);
  std::vector<Index> rows;
  for (Index k = 0; k < count * size; ++k) rows.push_back(vertex(random));
  return rows;
}

bool lists_each_once(LargeArray<Index> items, Index count) {
  std::sort(items.begin(), items.end());
  items.erase(items.begin(), std::find_if(items.begin(), items.end(), [](Index item) { return item >= 0; }));
  LargeArray<Index> all(at(count));
  std::iota(all.begin(), all.end(), 0);
  return items == all;
}

/// Sum over the blocks of a group.
float sum_of_diagonals(const LargeArray<Index>& order, const NumberedPoints& centres, std::span<const Index> groups,
                       Index group) {
  float sum = 0;
  for (std::size_t first = 0; first < order.size(); first += 8) {
    Eigen::AlignedBox3f box;
    for (std::size_t place = first; place < first + 8 && groups[at(order[first])] == group; ++place)
      if (order[place] >= 0) box.extend(Eigen::Map<const Eigen::Vector3f>(centres[at(order[place])].position.data()));
    if (!box.isEmpty()) sum += box.diagonal().norm();
  }
  return sum;
}

}  // namespace

TEST_CASE("corner order: as a stable sort by the first or middle corner") {
  const std::vector<Index> places = random_places();
  for (const Index size : {2, 3}) {
    constexpr Index count = 7001;
    const std::vector<Index> rows = random_rows(count, size);
    const auto key = [&](Index primitive) {
      std::vector<Index> corners;
      for (Index k = 0; k < size; ++k)
        corners.push_back(places[static_cast<std::size_t>(rows[static_cast<std::size_t>(primitive * size + k)])]);
      std::sort(corners.begin(), corners.end());
      return corners[static_cast<std::size_t>(size == 3)];
    };
    LargeArray<Index> expected(at(count));
    std::iota(expected.begin(), expected.end(), 0);
    std::stable_sort(expected.begin(), expected.end(), [&](Index a, Index b) { return key(a) < key(b); });
    CHECK(order_by_corners(rows.data(), count, size, places) == expected);
  }
  CHECK(order_by_corners(nullptr, 0, 2, {}).empty());
}

TEST_CASE("block order along a given order: every primitive once, one group in each block, the same on all threads") {
  for (const Index count : {0, 1, 9, 600, 5000}) {
    NumberedPoints centres = random_points(count);
    sort_along_curve(centres);
    std::vector<Index> groups;
    for (Index k = 0; k < count; ++k) groups.push_back(k * 7 % 3);
    for (const std::vector<Index>& of_group : {std::vector<Index>(), groups}) {
      const LargeArray<Index> order = block_order_along(centres, of_group, 8, Execution(1));
      CHECK(order.size() % 8 == 0);
      CHECK(lists_each_once(order, count));
      CHECK(order == block_order_along(centres, of_group, 8, Execution(3)));
      for (std::size_t place = 0; place < order.size() && !of_group.empty(); ++place)
        if (order[place] >= 0)
          CHECK(of_group[static_cast<std::size_t>(order[place])] ==
                of_group[static_cast<std::size_t>(order[place / 8 * 8])]);
    }
  }
}

TEST_CASE("block order: large groups have consecutive places, though they lie in the same region") {
  constexpr Index large = 3 << 14, small = 500, count = 2 * large + 2 * small;
  const NumberedPoints centres = random_points(count);
  std::vector<Index> groups(static_cast<std::size_t>(count), 0);
  for (Index k = 0; k < 2 * large; ++k) groups[static_cast<std::size_t>(k)] = 1 + k % 2;
  for (Index k = 0; k < small; ++k) groups[static_cast<std::size_t>(count - 1 - k)] = 3;
  const LargeArray<Index> order = block_order(centres, groups, 8, Execution(1));
  CHECK(lists_each_once(order, count));
  CHECK(order == block_order(centres, groups, 8, Execution(3)));
  std::array<int, 4> runs{};
  for (std::size_t place = 0; place < order.size(); place += 8) {
    const Index group = groups[static_cast<std::size_t>(order[place])];
    const bool begins = place == 0 || group != groups[static_cast<std::size_t>(order[place - 8])];
    runs[static_cast<std::size_t>(group)] += begins;
  }
  CHECK(runs[1] == 1);
  CHECK(runs[2] == 1);
  CHECK(runs[0] > 2);  // small groups share nodes
  CHECK(runs[3] > 2);
}

TEST_CASE("block order: large groups at rest are ordered along a curve, nearly as closely as others") {
  constexpr Index large = 3 << 14, count = 2 * large;
  const NumberedPoints centres = random_points(count);
  std::vector<Index> groups;
  for (Index k = 0; k < count; ++k) groups.push_back(k % 2);
  const std::vector<unsigned char> at_rest{0, 1};
  NumberedPoints along = centres;
  sort_along_curve(along);
  for (const bool in_order : {false, true}) {
    const auto order = [&](std::span<const unsigned char> resting, int threads) {
      const PrimitiveGroups both(groups, resting);
      return in_order ? block_order_along(along, both, 8, Execution(threads))
                      : block_order(centres, both, 8, Execution(threads));
    };
    const LargeArray<Index> with_splits = order({}, 1), resting = order(at_rest, 1);
    CHECK(lists_each_once(resting, count));
    CHECK(resting == order(at_rest, 3));
    CHECK(resting != with_splits);
    const auto sum = [&](const LargeArray<Index>& places, Index group) {
      return sum_of_diagonals(places, centres, groups, group);
    };
    CHECK(sum(resting, 0) == sum(with_splits, 0));
    CHECK(sum(resting, 1) < 1.3F * sum(with_splits, 1));
  }
}

TEST_CASE("divided order: large groups at rest have blocks of their own, and all keep the given order") {
  constexpr Index large = (3 << 14) + 1, small = 100, count = 2 * large + 2 * small;
  std::vector<Index> order(at(count)), groups;
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(8));
  for (Index k = 0; k < count; ++k) groups.push_back(k % 2 + (k < 2 * large ? 0 : 2));
  LargeArray<Index> resting, others, all(order.begin(), order.end());
  for (const Index group : {0, 1}) {
    std::ranges::copy_if(order, std::back_inserter(resting), [&](Index k) { return groups[at(k)] == group; });
    resting.resize((resting.size() + 7) / 8 * 8, -1);
  }
  std::ranges::copy_if(order, std::back_inserter(others), [&](Index k) { return groups[at(k)] > 1; });
  const std::vector<unsigned char> at_rest{1, 1, 0, 1};  // the last one is small
  const DividedOrder divided = divide_order(order, PrimitiveGroups(groups, at_rest), 8);
  CHECK(divided.resting_blocks == resting);
  CHECK(divided.others == others);
  CHECK(divide_order(order, PrimitiveGroups(groups), 8).others == all);
  CHECK(divide_order(order, {}, 8).others == all);
}
