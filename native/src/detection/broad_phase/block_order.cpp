// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/block_order.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "detection/broad_phase/curve_order.hpp"
#include "detection/broad_phase/window_order.hpp"

namespace stiv {

namespace {

using Items = std::span<NumberedPoint>;

/// Points in a window, without an order and in one that is known. Larger ones cost more time, and yield slightly
/// closer runs.
constexpr std::size_t window_size = window_capacity;
constexpr std::size_t known_window_size = window_size / 2;

/// Primitives from which a group has subtrees of its own: the edges of a large body. Nodes with blocks of several
/// groups become large as these move apart.
constexpr std::size_t large_group = 3 << 14;

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

/// Sorts the points by group (at least 0); those of one group keep their order. A counting sort.
void sort_by_group(NumberedPoints& points, std::span<const Index> groups) {
  const auto before = [&](const NumberedPoint& a, const NumberedPoint& b) {
    return groups[a.number] < groups[b.number];
  };
  if (groups.empty() || std::is_sorted(points.begin(), points.end(), before)) return;
  std::vector<std::size_t> starts(static_cast<std::size_t>(*std::max_element(groups.begin(), groups.end())) + 1, 0);
  for (const NumberedPoint& point : points) ++starts[groups[point.number]];
  std::size_t sum = 0;
  for (std::size_t& start : starts) sum += std::exchange(start, sum);
  NumberedPoints sorted(points.size());
  for (const NumberedPoint& point : points) sorted[starts[groups[point.number]]++] = point;
  points = std::move(sorted);
}

/// Appends the numbers of the points, padded to whole blocks.
void append_blocks(std::span<const NumberedPoint> points, std::size_t block, LargeArray<Index>& places) {
  for (const NumberedPoint& point : points) places.push_back(point.number);
  places.resize((places.size() + block - 1) / block * block, -1);
}

/// Blocks of primitives, with the center of each.
class BlockList {
 public:
  explicit BlockList(std::size_t block) : block_(block) {}

  void add(std::span<const NumberedPoint> points) {
    const std::size_t blocks = (points.size() + block_ - 1) / block_;
    if (places_.empty()) {  // mostly all of the list
      places_.reserve(blocks * block_);
      centres_.reserve(blocks);
    }
    append_blocks(points, block_, places_);
    for (std::size_t first = 0; first < points.size(); first += block_)
      add_centre(points.subspan(first, std::min(block_, points.size() - first)));
  }

  /// Appends the places of the blocks in a spatial order.
  void append_ordered(const Execution& execution, LargeArray<Index>& order) {
    order_spatially(centres_, block_, Given::unordered, execution);
    for (const NumberedPoint& centre : centres_) {
      const auto first = places_.begin() + static_cast<std::ptrdiff_t>(block_) * centre.number;
      order.insert(order.end(), first, first + static_cast<std::ptrdiff_t>(block_));
    }
  }

 private:
  void add_centre(std::span<const NumberedPoint> points) {
    Eigen::AlignedBox3f box;
    for (const NumberedPoint& point : points) box.extend(Eigen::Map<const Eigen::Vector3f>(point.position.data()));
    const Eigen::Vector3f centre = box.center();
    centres_.push_back({{centre[0], centre[1], centre[2]}, static_cast<Index>(centres_.size())});
  }

  std::size_t block_;
  LargeArray<Index> places_;
  NumberedPoints centres_;
};

/// The order of several groups, given in sequence. A curve alone orders large ones at rest: nearly as closely, in a
/// fraction of the time.
LargeArray<Index> order_groups(Items points, Given given, const PrimitiveGroups& groups, std::size_t block,
                               const Execution& execution) {
  LargeArray<Index> order;
  order.reserve(points.size() + block);
  BlockList small(block);
  for (auto begin = points.begin(); begin != points.end();) {
    const auto end = std::find_if(begin, points.end(), [&](const NumberedPoint& point) {
      return groups.of_primitives[at(point.number)] != groups.of_primitives[at(begin->number)];
    });
    const Items group(begin, end);
    const bool is_large = group.size() >= large_group;
    if (is_large && groups.rests(groups.of_primitives[at(begin->number)])) {
      if (given == Given::unordered) sort_along_curve(group);
      append_blocks(group, block, order);
    } else {
      order_spatially(group, block, given, execution);
      BlockList large(block);
      (is_large ? large : small).add(group);
      large.append_ordered(execution, order);
    }
    begin = end;
  }
  small.append_ordered(execution, order);
  return order;
}

LargeArray<Index> block_order(NumberedPoints points, Given given, const PrimitiveGroups& groups, std::size_t block,
                              const Execution& execution) {
  const std::span<const Index> of_primitives = groups.of_primitives;
  sort_by_group(points, of_primitives);
  const bool is_one_group = of_primitives.empty() || points.empty() ||
                            of_primitives[at(points.front().number)] == of_primitives[at(points.back().number)];
  if (!is_one_group) return order_groups(points, given, groups, block, execution);
  order_spatially(points, block, given, execution);
  LargeArray<Index> places;
  places.reserve(points.size() + block);
  append_blocks(points, block, places);
  return places;
}

}  // namespace

LargeArray<Index> block_order(NumberedPoints centres, const PrimitiveGroups& groups, Index block,
                              const Execution& execution) {
  return block_order(std::move(centres), Given::unordered, groups, static_cast<std::size_t>(block), execution);
}

LargeArray<Index> block_order_along(NumberedPoints centres, const PrimitiveGroups& groups, Index block,
                                    const Execution& execution) {
  return block_order(std::move(centres), Given::in_order, groups, static_cast<std::size_t>(block), execution);
}

DividedOrder divide_order(std::span<const Index> order, const PrimitiveGroups& groups, Index block) {
  std::vector<std::size_t> counts(groups.at_rest.size(), 0);
  for (const Index group : groups.of_primitives)
    if (groups.rests(group)) ++counts[at(group)];
  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> places(counts.size(), none);  // of the next primitive of each large group
  std::size_t end = 0, resting = 0;
  for (std::size_t group = 0; group < counts.size(); ++group) {
    if (counts[group] < large_group) continue;
    places[group] = end;
    resting += counts[group];
    end += (counts[group] + at(block) - 1) / at(block) * at(block);
  }
  DividedOrder divided{LargeArray<Index>(end, -1), {}};
  divided.others.reserve(order.size() - resting);
  for (const Index primitive : order) {
    std::size_t* const place = end > 0 ? &places[at(groups.of_primitives[at(primitive)])] : nullptr;
    if (place != nullptr && *place != none)
      divided.resting_blocks[(*place)++] = primitive;
    else
      divided.others.push_back(primitive);
  }
  return divided;
}

}  // namespace stiv
