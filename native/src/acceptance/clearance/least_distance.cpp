// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/acceptance/least_distance.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <tuple>

#include "acceptance/clearance/triangle_distance.hpp"
#include "acceptance/intersection/placed_vertices.hpp"
#include "acceptance/intersection/primitives.hpp"
#include "stiv/acceptance/intersections.hpp"

namespace stiv {

namespace {

double squared_gap(const PackedBox& a, const PackedBox& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double one = double(a.values[k]) + double(b.values[k + 3]);
    const double other = double(b.values[k]) + double(a.values[k + 3]);
    const double gap = std::max({0.0, one, other});
    sum += gap * gap;
  }
  return sum;
}

/// A node of the tree or, at level -1, a position in the order of primitives.
struct Subtree {
  Index level = 0, node = 0;
  PackedBox box;
  Index group = 0;
};

/// Up to eight subtrees.
struct Subtrees {
  std::array<Subtree, Bvh::width> items;
  std::size_t count = 0;
};

/// Branch and bound over pairs of subtrees, closest first.
class Search {
 public:
  Search(const Surface& surface, const Primitives& triangles, const PositionsView& q, DistancePairs pairs)
      : surface_(surface), triangles_(triangles), tree_(triangles.tree()), q_(q), pairs_(pairs) {}

  std::optional<NearestTriangles> run() {
    const auto top = static_cast<Index>(tree_.levels().size()) - 1;
    const Subtree root{top, 0, tree_.levels().back().boxes[0], tree_.levels().back().groups[0]};
    visit(root, root);
    return best_;
  }

 private:
  struct Pair {
    double bound = 0;
    std::uint8_t a = 0, b = 0;
  };

  void visit(const Subtree& a, const Subtree& b) {
    const bool same = a.level == b.level && a.node == b.node;
    const Subtrees first = a.level >= b.level ? children(a) : itself(a);
    const Subtrees second = b.level >= a.level ? children(b) : itself(b);
    std::array<Pair, Bvh::width * Bvh::width> pairs;
    std::size_t count = 0;
    for (std::size_t i = 0; i < first.count; ++i)
      for (std::size_t j = same ? i : 0; j < second.count; ++j) {
        const Subtree &x = first.items[i], &y = second.items[j];
        if ((same && i == j && x.level < 0) || !is_counted(x.group, y.group)) continue;
        const double bound = squared_gap(x.box, y.box);
        if (bound < squared_best_) pairs[count++] = {bound, std::uint8_t(i), std::uint8_t(j)};
      }
    std::sort(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Pair& x, const Pair& y) { return std::tie(x.bound, x.a, x.b) < std::tie(y.bound, y.a, y.b); });
    for (std::size_t k = 0; k < count && pairs[k].bound < squared_best_; ++k) {
      const Subtree &x = first.items[pairs[k].a], &y = second.items[pairs[k].b];
      if (x.level < 0 && y.level < 0)
        examine(tree_.order()[at(x.node)], tree_.order()[at(y.node)], pairs[k].bound == 0);
      else
        visit(x, y);
    }
  }

  static Subtrees itself(const Subtree& subtree) {
    Subtrees result;
    result.items[result.count++] = subtree;
    return result;
  }

  Subtrees children(const Subtree& subtree) const {
    const Bvh::Level& level = tree_.levels()[at(subtree.level)];
    const Bvh::Node& node = level.nodes[at(subtree.node)];
    const Index below = subtree.level > 0 ? static_cast<Index>(tree_.levels()[at(subtree.level - 1)].nodes.size())
                                          : static_cast<Index>(tree_.order().size());
    Subtrees result;
    for (Index lane = 0; lane < std::min(Bvh::width, below - subtree.node * Bvh::width); ++lane) {
      const Index child = subtree.node * Bvh::width + lane;
      if (subtree.level == 0 && tree_.order()[at(child)] < 0) continue;
      Subtree& next = result.items[result.count++];
      next.level = subtree.level - 1;
      next.node = child;
      for (std::size_t k = 0; k < 7; ++k) next.box.values[k] = node.planes[k][lane];
      next.group = subtree.level > 0 ? tree_.levels()[at(subtree.level - 1)].groups[at(child)] : subtree.group;
    }
    return result;
  }

  bool is_counted(Index a, Index b) const {
    if (a == Bvh::mixed || b == Bvh::mixed) return true;
    return (pairs_ == DistancePairs::all || a != b) && surface_.bodies_meet(a, b);
  }

  void examine(Index a, Index b, bool boxes_overlap) {
    if (a > b) std::swap(a, b);
    const std::array<Index, 3>&first = triangles_.corners(a), &second = triangles_.corners(b);
    for (const Index corner : first)
      if (std::find(second.begin(), second.end(), corner) != second.end()) return;
    if (best_ && least_triangle_distance(first, second, q_) >= best_->distance) return;
    NearestTriangles nearest = triangle_distance(first, second, q_);
    if (boxes_overlap && triangles_intersect(first, second, q_)) nearest.distance = 0;
    if (best_ && nearest.distance >= best_->distance) return;
    nearest.triangles = {a, b};
    best_ = nearest;
    squared_best_ = nearest.distance * nearest.distance;
  }

  const Surface& surface_;
  const Primitives& triangles_;
  const Bvh& tree_;
  PositionsView q_;
  DistancePairs pairs_;
  std::optional<NearestTriangles> best_;
  double squared_best_ = std::numeric_limits<double>::infinity();
};

}  // namespace

class LeastDistance::Implementation {
 public:
  explicit Implementation(std::shared_ptr<const Surface> surface)
      : surface_(std::move(surface)), triangles_(*surface_, triangle_corners(*surface_)) {}

  std::optional<NearestTriangles> find(const PositionsView& q, DistancePairs pairs) {
    surface_->check_positions(q);
    if (triangles_.empty()) return std::nullopt;
    const Execution execution(1);
    PlacedVertices placed(*surface_);
    placed.update(q, {}, 0, execution);
    triangles_.note_changes(placed.changed_bodies());
    triangles_.update(placed.boxes(), execution);
    return Search(*surface_, triangles_, q, pairs).run();
  }

 private:
  std::shared_ptr<const Surface> surface_;
  Primitives triangles_;
};

LeastDistance::LeastDistance(std::shared_ptr<const Surface> surface)
    : implementation_(std::make_unique<Implementation>(std::move(surface))) {}
LeastDistance::~LeastDistance() = default;
LeastDistance::LeastDistance(LeastDistance&&) noexcept = default;
LeastDistance& LeastDistance::operator=(LeastDistance&&) noexcept = default;

std::optional<NearestTriangles> LeastDistance::find(const PositionsView& q, DistancePairs pairs) {
  const FloatingPointScope floating_point;
  return implementation_->find(q, pairs);
}

}  // namespace stiv
