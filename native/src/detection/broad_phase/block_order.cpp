// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/block_order.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "detection/broad_phase/curve_order.hpp"
#include "detection/broad_phase/window_order.hpp"

namespace stiv {

namespace {

using Points = std::vector<NumberedPoint>;
using Items = std::span<NumberedPoint>;

/// Points in a window, without an order and in one that is known. Larger ones cost more time, and yield slightly
/// closer runs.
constexpr std::size_t window_size = window_capacity;
constexpr std::size_t known_window_size = window_size / 2;

/// Blocks from which a group has subtrees of its own. Nodes with blocks of several groups are large once these have
/// moved relative to each other.
constexpr std::size_t large_group = 1024;

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
void sort_by_group(Points& points, const std::vector<Index>& groups) {
  const auto before = [&](const NumberedPoint& a, const NumberedPoint& b) {
    return groups[a.number] < groups[b.number];
  };
  if (groups.empty() || std::is_sorted(points.begin(), points.end(), before)) return;
  std::vector<std::size_t> starts(static_cast<std::size_t>(*std::max_element(groups.begin(), groups.end())) + 1, 0);
  for (const Index group : groups) ++starts[group];
  std::size_t sum = 0;
  for (std::size_t& start : starts) sum += std::exchange(start, sum);
  const Points unsorted = points;
  for (const NumberedPoint& point : unsorted) points[starts[groups[point.number]]++] = point;
}

/// Appends the numbers of the points, padded to whole blocks.
void append_blocks(std::span<const NumberedPoint> points, std::size_t block, std::vector<Index>& places) {
  for (const NumberedPoint& point : points) places.push_back(point.number);
  places.resize((places.size() + block - 1) / block * block, -1);
}

/// The blocks of small groups, of which nodes may hold several, and those of large groups, which follow.
class BlockList {
 public:
  explicit BlockList(std::size_t block) : block_(block) {}

  void add(std::span<const NumberedPoint> group) {
    const bool is_large = group.size() >= large_group * block_;
    append_blocks(group, block_, is_large ? of_large_ : of_small_);
    if (!is_large) append_centres(group);
    small_groups_ += is_large ? 0 : 1;
  }

  std::vector<Index> ordered(const Execution& execution) && {
    std::vector<Index> order = small_groups_ > 1 ? ordered_small(execution) : std::move(of_small_);
    order.insert(order.end(), of_large_.begin(), of_large_.end());
    return order;
  }

 private:
  /// Appends the center of each block.
  void append_centres(std::span<const NumberedPoint> points) {
    for (std::size_t first = 0; first < points.size(); first += block_) {
      Eigen::AlignedBox3f box;
      for (const NumberedPoint& point : points.subspan(first, std::min(block_, points.size() - first)))
        box.extend(Eigen::Map<const Eigen::Vector3f>(point.position.data()));
      const Eigen::Vector3f centre = box.center();
      centres_.push_back({{centre[0], centre[1], centre[2]}, static_cast<Index>(centres_.size())});
    }
  }

  std::vector<Index> ordered_small(const Execution& execution) {
    order_spatially(centres_, block_, Given::unordered, execution);
    std::vector<Index> order;
    order.reserve(of_small_.size() + of_large_.size());
    for (const NumberedPoint& centre : centres_) {
      const auto first = of_small_.begin() + static_cast<std::ptrdiff_t>(block_) * centre.number;
      order.insert(order.end(), first, first + static_cast<std::ptrdiff_t>(block_));
    }
    return order;
  }

  std::size_t block_;
  std::vector<Index> of_small_, of_large_;
  Points centres_;  // of the blocks of small groups
  int small_groups_ = 0;
};

std::vector<Index> block_order(Points points, Given given, const std::vector<Index>& groups, std::size_t block,
                               const Execution& execution) {
  const auto group = [&](const NumberedPoint& point) { return groups.empty() ? 0 : groups[point.number]; };
  sort_by_group(points, groups);
  BlockList blocks(block);
  for (auto begin = points.begin(); begin != points.end();) {
    const auto differs = [&](const NumberedPoint& point) { return group(point) != group(*begin); };
    const auto end = groups.empty() ? points.end() : std::find_if(begin, points.end(), differs);
    const Items items(begin, end);
    order_spatially(items, block, given, execution);
    blocks.add(items);
    begin = end;
  }
  return std::move(blocks).ordered(execution);
}

}  // namespace

std::vector<Index> block_order(Points centres, const std::vector<Index>& groups, Index block,
                               const Execution& execution) {
  return block_order(std::move(centres), Given::unordered, groups, static_cast<std::size_t>(block), execution);
}

std::vector<Index> block_order_along(Points centres, const std::vector<Index>& groups, Index block,
                                     const Execution& execution) {
  return block_order(std::move(centres), Given::in_order, groups, static_cast<std::size_t>(block), execution);
}

}  // namespace stiv
