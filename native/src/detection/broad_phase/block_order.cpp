// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/block_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "detection/broad_phase/median_split.hpp"

namespace stiv {

namespace {

using Points = std::vector<Eigen::Vector3f>;
using Items = std::span<NumberedPoint>;

/// Below this number of items, sharing the work takes longer.
constexpr std::size_t few = 4096;

/// The first half is the largest power of two times `run` that fits, so halves of all sizes end where nodes of the tree
/// end. The second one is empty if a single run is left.
std::array<Items, 2> split(Items items, std::size_t run) {
  if (items.size() <= run) return {items, {}};
  std::size_t half = run;
  while (2 * half < items.size()) half *= 2;
  split_at_median(items, half);
  return {items.first(half), items.subspan(half)};
}

void order_spatially(Items items, std::size_t run) {
  if (items.size() <= run) return;
  for (const Items half : split(items, run)) order_spatially(half, run);
}

/// The threads share the parts of each of the first levels, then the parts below them.
void order_spatially(Items items, std::size_t run, const Execution& execution) {
  constexpr int shared_levels = 5;
  std::vector<Items> parts{items};
  for (int level = 0; level < shared_levels; ++level) {
    std::vector<Items> halves(2 * parts.size());
    execution.for_chunks(static_cast<Index>(parts.size()), 1, [&](Index part, Index, Index) {
      const auto k = static_cast<std::size_t>(part);
      const auto [first, second] = split(parts[k], run);
      halves[2 * k] = first;
      halves[2 * k + 1] = second;
    });
    parts = std::move(halves);
  }
  execution.for_chunks(static_cast<Index>(parts.size()), 1,
                       [&](Index part, Index, Index) { order_spatially(parts[static_cast<std::size_t>(part)], run); });
}

void order_spatially(std::span<Index> numbers, const Points& centres, std::size_t run, const Execution& execution) {
  std::vector<NumberedPoint> items;
  items.reserve(numbers.size());
  for (const Index number : numbers) {
    const Eigen::Vector3f& centre = centres[number];
    items.push_back({{centre[0], centre[1], centre[2]}, number});
  }
  if (items.size() < few)
    order_spatially(items, run);
  else
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
  const std::vector<Index> places = order_in_groups(centres, groups, block, execution);
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
