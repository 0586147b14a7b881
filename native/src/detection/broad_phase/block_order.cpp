// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/block_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "detection/broad_phase/curve_order.hpp"
#include "detection/broad_phase/numbered_point.hpp"
#include "detection/broad_phase/window_order.hpp"

namespace stiv {

namespace {

using Points = std::vector<Eigen::Vector3f>;
using Items = std::span<NumberedPoint>;

/// Points in a window, without an order and in one that is known. Larger ones cost more time, and yield slightly
/// closer runs.
constexpr std::size_t window_size = window_capacity;
constexpr std::size_t known_window_size = window_size / 2;

enum class Given { unordered, in_order };

/// A curve, or an order that is known already, replaces the first levels of median splits, which cost the most and
/// matter the least.
void order_spatially(Items items, std::size_t run, Given given, const Execution& execution) {
  const std::size_t window = given == Given::in_order ? known_window_size : window_size;
  if (given == Given::unordered && items.size() > window) sort_along_curve(items);
  execution.for_chunks(static_cast<Index>(items.size()), window_size, [&](Index begin, Index end, Index) {
    for (auto first = static_cast<std::size_t>(begin), last = static_cast<std::size_t>(end); first < last;
         first += window)
      order_window(items.subspan(first, std::min(window, last - first)), run);
  });
}

void order_spatially(std::span<Index> numbers, const Points& centres, std::size_t run, Given given,
                     const Execution& execution) {
  std::vector<NumberedPoint> items;
  items.reserve(numbers.size());
  for (const Index number : numbers) {
    const Eigen::Vector3f& centre = centres[number];
    items.push_back({{centre[0], centre[1], centre[2]}, number});
  }
  order_spatially(items, run, given, execution);
  std::transform(items.begin(), items.end(), numbers.begin(), [](const NumberedPoint& item) { return item.number; });
}

std::vector<Index> numbered(std::size_t count) {
  std::vector<Index> items(count);
  std::iota(items.begin(), items.end(), 0);
  return items;
}

/// Sorts the items by group (at least 0); items of one group keep their order. A counting sort.
void sort_by_group(std::vector<Index>& items, const std::vector<Index>& groups) {
  const auto before = [&](Index a, Index b) { return groups[a] < groups[b]; };
  if (groups.empty() || std::is_sorted(items.begin(), items.end(), before)) return;
  std::vector<std::size_t> starts(static_cast<std::size_t>(*std::max_element(groups.begin(), groups.end())) + 1, 0);
  for (const Index group : groups) ++starts[group];
  std::size_t sum = 0;
  for (std::size_t& start : starts) sum += std::exchange(start, sum);
  const std::vector<Index> unsorted = items;
  for (const Index item : unsorted) items[starts[groups[item]]++] = item;
}

/// Primitives of each group in spatial order, group by group. Each group is padded to whole blocks.
std::vector<Index> order_in_groups(std::vector<Index> items, Given given, const Points& centres,
                                   const std::vector<Index>& groups, std::size_t block, const Execution& execution) {
  const auto group = [&](Index item) { return groups.empty() ? 0 : groups[item]; };
  sort_by_group(items, groups);
  std::vector<Index> places;
  places.reserve(items.size() + block);
  for (auto begin = items.begin(); begin != items.end();) {
    const Index common = group(*begin);
    const auto end = std::find_if(begin, items.end(), [&](Index item) { return group(item) != common; });
    order_spatially({begin, end}, centres, block, given, execution);
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
      if (places[place] >= 0) box.extend(centres[places[place]]);
    result.push_back(box.center());
  }
  return result;
}

std::vector<Index> block_order(std::vector<Index> items, Given given, const Points& centres,
                               const std::vector<Index>& groups, Index block, const Execution& execution) {
  std::vector<Index> places = order_in_groups(std::move(items), given, centres, groups, block, execution);
  const auto differs = [&](Index group) { return group != groups.front(); };
  if (std::none_of(groups.begin(), groups.end(), differs)) return places;
  const Points block_centres = centres_of_blocks(places, centres, block);
  std::vector<Index> blocks = numbered(block_centres.size());
  order_spatially(blocks, block_centres, block, Given::unordered, execution);
  std::vector<Index> order;
  order.reserve(places.size());
  for (const Index first : blocks)
    order.insert(order.end(), places.begin() + first * block, places.begin() + (first + 1) * block);
  return order;
}

}  // namespace

std::vector<Index> block_order(const Points& centres, const std::vector<Index>& groups, Index block,
                               const Execution& execution) {
  return block_order(numbered(centres.size()), Given::unordered, centres, groups, block, execution);
}

std::vector<Index> block_order_along(std::vector<Index> items, const Points& centres, const std::vector<Index>& groups,
                                     Index block, const Execution& execution) {
  return block_order(std::move(items), Given::in_order, centres, groups, block, execution);
}

}  // namespace stiv
