// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/acceptance/least_distance.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "acceptance/primitives.hpp"
#include "acceptance/triangle_distance.hpp"
#include "stiv/acceptance/intersections.hpp"

namespace stiv {

namespace {

std::size_t place(Index k) { return static_cast<std::size_t>(k); }

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

/// A node of the tree, or at level -1 a primitive: a place in the blocks.
struct Part {
  Index level = 0, node = 0;
  bool operator==(const Part& other) const { return level == other.level && node == other.node; }
};

/// Branch and bound over pairs of nodes, nearest first.
class Search {
 public:
  Search(const Surface& surface, const Primitives& triangles, const Positions& q, bool within)
      : surface_(surface), triangles_(triangles), tree_(triangles.tree()), q_(q), within_(within) {}

  std::optional<NearestTriangles> run() {
    const Part root{static_cast<Index>(tree_.levels().size()) - 1, 0};
    visit(root, root);
    return best_;
  }

 private:
  struct Pair {
    double bound;
    Part a, b;
  };

  void visit(const Part& a, const Part& b) {
    if (a.level < 0 && b.level < 0) return examine(tree_.order()[place(a.node)], tree_.order()[place(b.node)]);
    std::vector<Pair> pairs = pairs_below(a, b);
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) { return x.bound < y.bound; });
    for (const Pair& pair : pairs) {
      if (pair.bound >= squared_best_) return;
      visit(pair.a, pair.b);
    }
  }

  std::vector<Pair> pairs_below(const Part& a, const Part& b) const {
    const bool alike = a == b;
    std::vector<Pair> pairs;
    for (const Part& x : a.level >= b.level ? children(a) : std::vector<Part>{a})
      for (const Part& y : b.level >= a.level ? children(b) : std::vector<Part>{b}) {
        if (alike && (y.node < x.node || (x.level < 0 && x == y))) continue;
        if (!may_count(group(x), group(y))) continue;
        const double bound = squared_gap(box(x), box(y));
        if (bound < squared_best_) pairs.push_back({bound, x, y});
      }
    return pairs;
  }

  std::vector<Part> children(const Part& part) const {
    const Index count = part.level > 0 ? static_cast<Index>(tree_.levels()[place(part.level - 1)].nodes.size())
                                       : static_cast<Index>(tree_.order().size());
    std::vector<Part> parts;
    for (Index node = part.node * Bvh::width; node < std::min(count, (part.node + 1) * Bvh::width); ++node)
      if (part.level > 0 || tree_.order()[place(node)] >= 0) parts.push_back({part.level - 1, node});
    return parts;
  }

  PackedBox box(const Part& part) const {
    if (part.level >= 0) return tree_.levels()[place(part.level)].boxes[place(part.node)];
    const Bvh::Node& block = tree_.levels()[0].nodes[place(part.node / Bvh::width)];
    PackedBox packed{};
    for (std::size_t k = 0; k < 7; ++k) packed.values[k] = block.planes[k][part.node % Bvh::width];
    return packed;
  }

  Index group(const Part& part) const {
    if (part.level < 0) return tree_.levels()[0].groups[place(part.node / Bvh::width)];
    return tree_.levels()[place(part.level)].groups[place(part.node)];
  }

  bool may_count(Index a, Index b) const {
    if (a == Bvh::mixed || b == Bvh::mixed) return true;
    return (within_ || a != b) && surface_.bodies_meet(a, b);
  }

  void examine(Index a, Index b) {
    if (a > b) std::swap(a, b);
    const std::array<Index, 3>&first = triangles_.corners(a), &second = triangles_.corners(b);
    for (const Index corner : first)
      if (std::find(second.begin(), second.end(), corner) != second.end()) return;
    NearestTriangles nearest = triangle_distance(first, second, q_);
    if (triangles_intersect(first, second, q_)) nearest.distance = 0;
    if (best_ && nearest.distance >= best_->distance) return;
    nearest.triangles = {a, b};
    best_ = nearest;
    squared_best_ = nearest.distance * nearest.distance;
  }

  const Surface& surface_;
  const Primitives& triangles_;
  const Bvh& tree_;
  const Positions& q_;
  bool within_;
  std::optional<NearestTriangles> best_;
  double squared_best_ = std::numeric_limits<double>::infinity();
};

}  // namespace

class LeastDistance::Implementation {
 public:
  explicit Implementation(std::shared_ptr<const Surface> surface)
      : surface_(std::move(surface)), triangles_(*surface_, triangle_corners(*surface_)) {}

  std::optional<NearestTriangles> find(const Positions& q, bool within) {
    surface_->check_positions(q);
    if (triangles_.empty()) return std::nullopt;
    triangles_.update(vertex_bounds(q), {});
    return Search(*surface_, triangles_, q, within).run();
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

std::optional<NearestTriangles> LeastDistance::find(const Positions& q, bool within) {
  return implementation_->find(q, within);
}

}  // namespace stiv
