// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/bvh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace stiv {

namespace {

/// Tasks, starting with the pair of roots, level by level.
class TaskList {
 public:
  TaskList(const Bvh& a, const Bvh& b, const GroupRelations& groups) : a_(a), b_(b), groups_(groups) {}

  std::vector<Bvh::Task> make(std::size_t about) {
    std::vector<Bvh::Task> tasks;
    if (a_.size() == 0 || b_.size() == 0) return tasks;
    add(tasks, {static_cast<Index>(a_.levels().size()) - 1, 0, static_cast<Index>(b_.levels().size()) - 1, 0});
    while (tasks.size() < enough(tasks, about)) {
      std::vector<Bvh::Task> next;
      bool divided = false;
      for (const Bvh::Task& task : tasks) divided |= divide(task, next);
      tasks = std::move(next);
      if (!divided) break;
    }
    return tasks;
  }

 private:
  /// Tasks near the blocks hold little work, so fewer of them are enough. All tasks have the same two levels.
  static std::size_t enough(const std::vector<Bvh::Task>& tasks, std::size_t about) {
    constexpr Index low = 2;
    constexpr std::size_t fewer = 8;
    const bool are_low = !tasks.empty() && std::max(tasks[0].level, tasks[0].other_level) <= low;
    return are_low ? about / fewer : about;
  }

  void add(std::vector<Bvh::Task>& tasks, const Bvh::Task& task) const {
    const Bvh::Level &a = a_.levels()[task.level], &b = b_.levels()[task.other_level];
    const Index group = a.groups[task.node], other = b.groups[task.other_node];
    if (group != Bvh::mixed && other != Bvh::mixed && !groups_.table.meet(group, other)) return;
    if (may_meet_in_frames(a.boxes[task.node], group, b.boxes[task.other_node], other)) tasks.push_back(task);
  }

  bool may_meet_in_frames(const PackedBox& box, Index group, const PackedBox& other_box, Index other) const {
    if (groups_.frames.are_alike()) return may_meet(box, other_box);
    return may_meet(grown(box, groups_.frames.growth(group, other)), other_box);
  }

  /// Replaces both subtrees, or the higher one, with their children. False if they are blocks.
  bool divide(const Bvh::Task& task, std::vector<Bvh::Task>& tasks) const {
    if (task.level == 0 && task.other_level == 0) {
      tasks.push_back(task);
      return false;
    }
    const bool same = &a_ == &b_ && task.level == task.other_level && task.node == task.other_node;
    const Index level = task.level >= task.other_level ? task.level - 1 : task.level;
    const Index other_level = task.other_level >= task.level ? task.other_level - 1 : task.other_level;
    const auto [begin, end] = children(a_, task.level, task.node, level);
    const auto [other_begin, other_end] = children(b_, task.other_level, task.other_node, other_level);
    const PackedBox& other_box = b_.levels()[task.other_level].boxes[task.other_node];
    const Index group = a_.levels()[task.level].groups[task.node];
    const Index other_group = b_.levels()[task.other_level].groups[task.other_node];
    for (Index node = begin; node < end; ++node) {
      if (!may_meet_in_frames(a_.levels()[level].boxes[node], group, other_box, other_group)) continue;
      for (Index other = same ? node : other_begin; other < other_end; ++other)
        add(tasks, {level, node, other_level, other});
    }
    return true;
  }

  static std::pair<Index, Index> children(const Bvh& tree, Index level, Index node, Index down_to) {
    if (level == down_to) return {node, node + 1};
    const auto count = static_cast<Index>(tree.levels()[down_to].nodes.size());
    return {node * Bvh::width, std::min(count, (node + 1) * Bvh::width)};
  }

  const Bvh &a_, &b_;
  const GroupRelations& groups_;
};

}  // namespace

NumberedPoint centre_of(const Bounds& box, Index number) {
  NumberedPoint centre;
  centre.number = number;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float middle = box.low[axis] / 2 + box.high[axis] / 2;
    centre.position[axis] = std::isfinite(middle) ? middle : 0;
  }
  return centre;
}

NumberedPoints centres_of(const std::vector<Bounds>& boxes) {
  NumberedPoints centres;
  centres.reserve(boxes.size());
  for (const Bounds& box : boxes) centres.push_back(centre_of(box, static_cast<Index>(centres.size())));
  return centres;
}

Bvh::Bvh(NumberedPoints centres, const PrimitiveGroups& groups, const CornerRows& corners, const Execution& execution)
    : size_(static_cast<Index>(centres.size())), order_(block_order(std::move(centres), groups, width, execution)) {
  begin(groups.of_primitives, corners, execution);
}

Bvh::Bvh(LargeArray<Index> order, Index count, std::span<const Index> groups, const CornerRows& corners,
         const Execution& execution)
    : size_(count), order_(std::move(order)) {
  begin(groups, corners, execution);
}

void Bvh::begin(std::span<const Index> groups, const CornerRows& corners, const Execution& execution) {
  reserve_levels(groups);
  const Index last_group = groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end());
  set_corners(corners, std::vector<unsigned char>(static_cast<std::size_t>(last_group) + 1, 1), execution);
}

Bvh::Bvh(const std::vector<Bounds>& boxes, std::span<const Index> groups, const CornerRows& corners)
    : Bvh(centres_of(boxes), groups, corners, Execution(1)) {
  refit(boxes);
}

void Bvh::reserve_levels(std::span<const Index> groups) {
  for (std::size_t count = order_.size() / width; count > 0; count = (count + width - 1) / width) {
    levels_.push_back({LargeArray<Node>(count), LargeArray<PackedBox>(count), LargeArray<Index>(count, 0)});
    if (count == 1) break;
  }
  if (groups.empty()) return;
  for (std::size_t block = 0; block < order_.size() / width; ++block)
    levels_[0].groups[block] = groups[order_[block * width]];
  for (std::size_t level = 1; level < levels_.size(); ++level)
    for (std::size_t child = 0; child < levels_[level - 1].groups.size(); ++child) {
      Index& group = levels_[level].groups[child / width];
      const Index below = levels_[level - 1].groups[child];
      group = child % width == 0 || group == below ? below : mixed;
    }
}

void Bvh::set_corners(const CornerRows& corners, const std::vector<unsigned char>& changed,
                      const Execution& execution) {
  corner_size_ = corners.size;
  incidence_.reset();
  const std::size_t block_size = static_cast<std::size_t>(corners.size) * width;
  const bool are_new = corners_.size() != order_.size() / width * block_size;
  corners_.resize(order_.size() / width * block_size);
  execution.for_chunks(static_cast<Index>(order_.size() / width), 2 * chunk_size, [&](Index begin, Index end, Index) {
    for (Index block = begin; block < end; ++block)
      if (changed[levels_[0].groups[block]] != 0)
        list_corners(corners, block, corners_);
      else if (are_new)
        std::fill_n(corners_.begin() + static_cast<std::ptrdiff_t>(block_size) * block, block_size, -1);
  });
}

LargeArray<Index> Bvh::block_corners(const CornerRows& rows) const {
  LargeArray<Index> corners(order_.size() * static_cast<std::size_t>(rows.size));
  for (Index block = 0; block < static_cast<Index>(order_.size() / width); ++block) list_corners(rows, block, corners);
  return corners;
}

void Bvh::list_corners(const CornerRows& rows, Index block, LargeArray<Index>& corners) const {
  const std::size_t size = rows.size;
  for (Index place = block * width; place < (block + 1) * width; ++place) {
    const Index primitive = order_[place];
    for (std::size_t k = 0; k < size; ++k)
      corners[(block * size + k) * width + place % width] = primitive >= 0 ? rows.rows[primitive * size + k] : -1;
  }
}

void Bvh::refit(const std::vector<Bounds>& boxes, const std::vector<unsigned char>& active) {
  const auto box_of = [&](Index primitive) {
    return PackedBox::of(boxes[primitive], active.empty() || active[primitive] != 0);
  };
  refit(box_of, Execution(1));
}

void Bvh::summarise_all(const Execution& execution) {
  for (std::size_t level = 1; level < levels_.size(); ++level)
    execution.for_chunks(static_cast<Index>(levels_[level].nodes.size()), chunk_size,
                         [&](Index begin, Index end, Index) { summarise(level, nullptr, begin, end); });
}

void Bvh::prepare_refit_some_corners(Index vertex_count) {
  const std::size_t block_size = static_cast<std::size_t>(corner_size_) * width;
  if (!incidence_) incidence_.emplace(corners_, block_size, vertex_count);
  is_touched_.resize((order_.size() / width + width - 1) / width * width, 0);
}

/// Sorts the blocks by marking them: blocks are few, and each is listed many times. Runs of vertices share a list,
/// since no processor predicts where short lists end.
void Bvh::find_touched(std::span<const Index> vertices) {
  for (std::size_t begin = 0, end; begin < vertices.size(); begin = end) {
    for (end = begin + 1; end < vertices.size() && vertices[end] == vertices[end - 1] + 1;) ++end;
    for (const Index block : incidence_->blocks_at(vertices[begin], vertices[end - 1] + 1)) is_touched_[block] = 1;
  }
  touched_.clear();
  for (std::size_t first = 0; first < is_touched_.size(); first += width) {
    std::uint64_t eight;
    std::memcpy(&eight, is_touched_.data() + first, sizeof(eight));
    if (eight == 0) continue;
    for (std::size_t block = first; block < first + width; ++block)
      if (std::exchange(is_touched_[block], 0) != 0) touched_.push_back(static_cast<Index>(block));
  }
}

void Bvh::list_parents(const std::vector<Index>& nodes, std::vector<Index>& parents) const {
  parents.clear();
  for (const Index node : nodes)
    if (parents.empty() || parents.back() != node / width) parents.push_back(node / width);
}

void Bvh::list_nodes_of(const std::vector<unsigned char>& groups) {
  if (groups == listed_groups_ && !group_nodes_.empty()) return;
  group_nodes_.assign(levels_.size(), {});
  listed_groups_ = groups;
  if (levels_.empty()) return;
  for (std::size_t block = 0; block < order_.size() / width; ++block)
    if (groups[levels_[0].groups[block]] != 0) group_nodes_[0].push_back(static_cast<Index>(block));
  for (std::size_t level = 1; level < levels_.size(); ++level)
    list_parents(group_nodes_[level - 1], group_nodes_[level]);
}

void Bvh::summarise_touched() {
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    list_parents(touched_, parents_);
    summarise(level, parents_.data(), 0, static_cast<Index>(parents_.size()));
    std::swap(touched_, parents_);
  }
}

void Bvh::refit_corners(std::span<const PackedBox> vertices, const Execution& execution) {
  if (levels_.empty()) return;
  execution.for_chunks(static_cast<Index>(levels_[0].nodes.size()), chunk_size, [&](Index begin, Index end, Index) {
    refit_blocks(nullptr, begin, end, corners_, vertices.data());
  });
  summarise_all(execution);
}

void Bvh::refit_groups_corners(const std::vector<unsigned char>& changed, std::span<const PackedBox> vertices,
                               const Execution& execution) {
  refit_groups_corners(changed, corners_, vertices, execution);
}

void Bvh::refit_groups_corners(const std::vector<unsigned char>& changed, std::span<const Index> block_corners,
                               std::span<const PackedBox> vertices, const Execution& execution) {
  list_nodes_of(changed);
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const std::vector<Index>& nodes = group_nodes_[level];
    execution.for_chunks(static_cast<Index>(nodes.size()), chunk_size, [&](Index begin, Index end, Index) {
      if (level == 0)
        refit_blocks(nodes.data(), begin, end, block_corners, vertices.data());
      else
        summarise(level, nodes.data(), begin, end);
    });
  }
}

void Bvh::refit_some_corners(std::span<const Index> changed, std::span<const PackedBox> vertices) {
  if (levels_.empty()) return;
  prepare_refit_some_corners(static_cast<Index>(vertices.size()));
  find_touched(changed);
  refit_blocks(touched_.data(), 0, static_cast<Index>(touched_.size()), corners_, vertices.data());
  summarise_touched();
}

std::vector<Bvh::Task> Bvh::tasks(const Bvh& other, const GroupRelations& groups, std::size_t about) const {
  return TaskList(*this, other, groups).make(about);
}

std::vector<std::pair<Index, Index>> Bvh::overlapping_pairs(const Bvh& a, const Bvh& b, const Execution& execution) {
  const std::vector<Task> tasks = a.tasks(b, {});
  std::vector<PairBuffer> found(tasks.size());
  execution.for_chunks(static_cast<Index>(tasks.size()), 1,
                       [&](Index task, Index, Index) { a.overlaps(tasks[task], b, {}, found[task]); });
  std::vector<std::pair<Index, Index>> pairs;
  for (const PairBuffer& buffer : found)
    for (std::size_t k = 0; k < buffer.count; ++k) pairs.emplace_back(buffer.first[k], buffer.second[k]);
  return pairs;
}

std::vector<std::pair<Index, Index>> Bvh::overlapping_pairs(const Bvh& tree, const Execution& execution) {
  return overlapping_pairs(tree, tree, execution);
}

}  // namespace stiv
