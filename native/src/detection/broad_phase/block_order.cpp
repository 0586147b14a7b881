// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/block_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "detection/broad_phase/curve_order.hpp"
#include "detection/broad_phase/median_split.hpp"
#include "detection/broad_phase/window_order.hpp"

namespace stiv {

namespace {

using Points = std::vector<Eigen::Vector3f>;
using Items = std::span<NumberedPoint>;

/// Runs in a window. More of them cost more time, and yield slightly closer runs.
constexpr std::size_t runs_in_window = 128;

void order_spatially(Items items, std::size_t run) {
  if (items.size() <= window_capacity) {
    order_window(items, run);
    return;
  }
  const std::size_t half = size_of_first_part(items.size(), run);
  split_at_median(items, half);
  order_spatially(items.first(half), run);
  order_spatially(items.subspan(half), run);
}

/// A curve replaces the first levels of median splits, which cost the most and matter the least.
void order_spatially(Items items, std::size_t run, const Execution& execution) {
  const std::size_t window = run * runs_in_window;
  if (items.size() > window) sort_along_curve(items);
  execution.for_chunks(
      static_cast<Index>(items.size()), static_cast<Index>(window), [&](Index begin, Index end, Index) {
        order_spatially(items.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)), run);
      });
}

void order_spatially(std::span<Index> numbers, const Points& centres, std::size_t run, const Execution& execution) {
  std::vector<NumberedPoint> items;
  items.reserve(numbers.size());
  for (const Index number : numbers) {
    const Eigen::Vector3f& centre = centres[number];
    items.push_back({{centre[0], centre[1], centre[2]}, number});
  }
  order_spatially(items, run, execution);
  std::transform(items.begin(), items.end(), numbers.begin(), [](const NumberedPoint& item) { return item.number; });
}

/// Numbers of the items, group by group.
std::vector<Index> by_group(std::size_t count, const std::vector<Index>& groups) {
  std::vector<Index> items(count);
  std::iota(items.begin(), items.end(), 0);
  const auto before = [&](Index a, Index b) { return groups[a] < groups[b]; };
  if (!std::is_sorted(groups.begin(), groups.end())) std::stable_sort(items.begin(), items.end(), before);
  return items;
}

/// Primitives of each group in spatial order, group by group. Each group is padded to whole blocks.
std::vector<Index> order_in_groups(const Points& centres, const std::vector<Index>& groups, std::size_t block,
                                   const Execution& execution) {
  const auto group = [&](Index item) { return groups.empty() ? 0 : groups[item]; };
  std::vector<Index> items = by_group(centres.size(), groups);
  std::vector<Index> places;
  for (auto begin = items.begin(); begin != items.end();) {
    const Index common = group(*begin);
    const auto end = std::find_if(begin, items.end(), [&](Index item) { return group(item) != common; });
    order_spatially({begin, end}, centres, block, execution);
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

}  // namespace

std::vector<Index> block_order(const Points& centres, const std::vector<Index>& groups, Index block,
                               const Execution& execution) {
  std::vector<Index> places = order_in_groups(centres, groups, block, execution);
  const auto differs = [&](Index group) { return group != groups.front(); };
  if (std::none_of(groups.begin(), groups.end(), differs)) return places;
  const Points block_centres = centres_of_blocks(places, centres, block);
  std::vector<Index> blocks(block_centres.size());
  std::iota(blocks.begin(), blocks.end(), 0);
  order_spatially(blocks, block_centres, block, execution);
  std::vector<Index> order;
  order.reserve(places.size());
  for (const Index first : blocks)
    order.insert(order.end(), places.begin() + first * block, places.begin() + (first + 1) * block);
  return order;
}

}  // namespace stiv
