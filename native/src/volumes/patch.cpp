// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/volumes/patch.hpp"

#include <algorithm>
#include <numeric>

namespace stiv {

namespace {

/// Union-find over regions. The smaller root wins, so that labels do not depend on the order of unions.
class Partition {
 public:
  explicit Partition(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  Index root(Index k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }

  void join(Index a, Index b) {
    const Index first = root(a), second = root(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

 private:
  std::vector<Index> parent_;
};

void join_neighbours(const Surface& surface, const std::vector<Region>& regions, Partition& partition) {
  std::vector<Index> place(static_cast<std::size_t>(surface.vertex_count()), -1);  // of each vertex's region
  for (Index k = 0; k < static_cast<Index>(regions.size()); ++k) place[at(regions[k].vertex)] = k;
  for (Index k = 0; k < static_cast<Index>(regions.size()); ++k) {
    const Index vertex = regions[k].vertex;
    for (const Index* other = surface.neighbours_begin(vertex); other != surface.neighbours_end(vertex); ++other) {
      if (*other >= vertex) break;  // each pair once: neighbors ascend
      const Index neighbour = place[at(*other)];
      if (neighbour >= 0 && !regions[k].rigid && !regions[neighbour].rigid) partition.join(k, neighbour);
    }
  }
}

void join_same_event(const std::vector<Region>& regions, Partition& partition) {
  std::vector<Index> order(regions.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return regions[a].event < regions[b].event; });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (regions[order[k]].event == regions[order[k - 1]].event) partition.join(order[k - 1], order[k]);
}

/// The label of each region's set, 0, 1, ... in the order of first regions.
std::vector<Index> numbered(Partition& partition, std::size_t size) {
  std::vector<Index> labels(size, 0);
  Index count = 0;
  for (Index k = 0; k < static_cast<Index>(size); ++k) {
    const Index root = partition.root(k);
    labels[k] = root == k ? count++ : labels[root];
  }
  return labels;
}

}  // namespace

std::vector<Index> patch_labels(const Surface& surface, const std::vector<Region>& regions, ConstraintKind kind) {
  if (kind == ConstraintKind::single) return std::vector<Index>(regions.size(), 0);
  Partition partition(regions.size());
  if (kind == ConstraintKind::per_patch) join_neighbours(surface, regions, partition);
  join_same_event(regions, partition);
  return numbered(partition, regions.size());
}

std::vector<Index> ring_labels(const Surface& surface, const std::vector<Region>& regions, ConstraintKind kind) {
  if (kind == ConstraintKind::single) return std::vector<Index>(regions.size(), 0);
  Partition partition(regions.size());
  join_neighbours(surface, regions, partition);
  return numbered(partition, regions.size());
}

}  // namespace stiv
