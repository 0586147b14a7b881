// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/block_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace stiv {

namespace {

using Points = std::vector<Eigen::Vector3f>;

std::size_t at(Index index) { return static_cast<std::size_t>(index); }

Eigen::Vector3f centre(const Bounds& box) {
  Eigen::Vector3f point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float middle = box.low[axis] / 2 + box.high[axis] / 2;
    point[static_cast<Index>(axis)] = std::isfinite(middle) ? middle : 0;
  }
  return point;
}

/// A centre and whose it is, side by side: selection goes over all of them many times.
struct Item {
  std::array<float, 3> centre;
  Index number;
};

std::vector<Item> items_of(std::span<const Index> numbers, const Points& centres) {
  std::vector<Item> items;
  items.reserve(numbers.size());
  for (const Index number : numbers) {
    const Eigen::Vector3f& point = centres[at(number)];
    items.push_back({{point[0], point[1], point[2]}, number});
  }
  return items;
}

std::size_t longest_axis(std::span<const Item> items) {
  std::array<float, 3> low = items.front().centre, high = low;
  for (const Item& item : items)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], item.centre[axis]);
      high[axis] = std::max(high[axis], item.centre[axis]);
    }
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
  return longest;
}

/// Moves the `half` first items along an axis to the front. Equal centres are told apart by number: the order must not
/// depend on the library's selection algorithm.
template <std::size_t axis>
void select_half(std::span<Item> items, std::size_t half) {
  const auto before = [](const Item& a, const Item& b) {
    return a.centre[axis] < b.centre[axis] || (a.centre[axis] == b.centre[axis] && a.number < b.number);
  };
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(), before);
}

/// Halves along the longest axis of the centres; the first half is as large a power of two times `run` as fits, so
/// that the halves of all sizes end where nodes of the tree end.
void order_spatially(std::span<Item> items, std::size_t run) {
  if (items.size() <= run) return;
  std::size_t half = run;
  while (2 * half < items.size()) half *= 2;
  constexpr std::array select{select_half<0>, select_half<1>, select_half<2>};
  select[longest_axis(items)](items, half);
  order_spatially(items.first(half), run);
  order_spatially(items.subspan(half), run);
}

void order_spatially(std::span<Index> numbers, const Points& centres, std::size_t run) {
  std::vector<Item> items = items_of(numbers, centres);
  order_spatially(items, run);
  std::transform(items.begin(), items.end(), numbers.begin(), [](const Item& item) { return item.number; });
}

/// Boxes of each group in spatial order, one group after the other, each filled up to whole blocks.
std::vector<Index> order_in_groups(const Points& centres, const std::vector<Index>& groups, std::size_t block) {
  const auto group = [&](Index item) { return groups.empty() ? 0 : groups[at(item)]; };
  std::vector<Index> items(centres.size());
  std::iota(items.begin(), items.end(), 0);
  std::stable_sort(items.begin(), items.end(), [&](Index a, Index b) { return group(a) < group(b); });
  std::vector<Index> places;
  for (auto begin = items.begin(); begin != items.end();) {
    const Index common = group(*begin);
    const auto end = std::find_if(begin, items.end(), [&](Index item) { return group(item) != common; });
    order_spatially({begin, end}, centres, block);
    places.insert(places.end(), begin, end);
    places.resize((places.size() + block - 1) / block * block, -1);
    begin = end;
  }
  return places;
}

Points centres_of_blocks(const std::vector<Index>& places, const Points& centres, std::size_t block) {
  Points result;
  for (std::size_t first = 0; first < places.size(); first += block) {
    Eigen::AlignedBox3f box;
    for (std::size_t place = first; place < first + block; ++place)
      if (places[place] >= 0) box.extend(centres[at(places[place])]);
    result.push_back(box.center());
  }
  return result;
}

}  // namespace

std::vector<Index> block_order(const std::vector<Bounds>& boxes, const std::vector<Index>& groups, Index block) {
  Points centres(boxes.size());
  std::transform(boxes.begin(), boxes.end(), centres.begin(), centre);
  const std::vector<Index> places = order_in_groups(centres, groups, at(block));
  const Points block_centres = centres_of_blocks(places, centres, at(block));
  std::vector<Index> blocks(block_centres.size());
  std::iota(blocks.begin(), blocks.end(), 0);
  order_spatially(blocks, block_centres, at(block));
  std::vector<Index> order;
  order.reserve(places.size());
  for (const Index first : blocks)
    order.insert(order.end(), places.begin() + first * block, places.begin() + (first + 1) * block);
  return order;
}

}  // namespace stiv
