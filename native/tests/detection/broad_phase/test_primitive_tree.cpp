// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <random>

#include "detection/broad_phase/primitive_tree.hpp"
#include "detection/broad_phase/relevance.hpp"
#include "detection/scenes.hpp"

using namespace stiv;

namespace {

constexpr Index side = 12, count = side * side * side;  // triangles, one in each cell of a cube

std::shared_ptr<const Surface> loose_triangles() {
  SurfaceDefinition definition;
  definition.vertex_count = 3 * count;
  definition.triangles.resize(count, 3);
  for (Index face = 0; face < count; ++face) definition.triangles.row(face) << 3 * face, 3 * face + 1, 3 * face + 2;
  return std::make_shared<const Surface>(definition);
}

/// Triangle k in cell `cells[k]`, which extends into the neighboring cells.
Positions placed(const std::vector<Index>& cells) {
  Positions q(3 * count, 3);
  for (Index face = 0; face < count; ++face) {
    const Index cell = cells[static_cast<std::size_t>(face)];
    const Vector3 corner(cell % side, cell / side % side, cell / (side * side));
    q.row(3 * face) = corner;
    q.row(3 * face + 1) = corner + Vector3(1.2, 0.3, 0.1);
    q.row(3 * face + 2) = corner + Vector3(0.2, 1.1, 0.4);
  }
  return q;
}

std::vector<Index> in_order() {
  std::vector<Index> cells(count);
  std::iota(cells.begin(), cells.end(), 0);
  return cells;
}

std::vector<Index> shuffled() {
  std::vector<Index> cells = in_order();
  std::mt19937 random(1);
  std::shuffle(cells.begin(), cells.end(), random);
  return cells;
}

/// Pairs of nodes whose children a traversal of the tree against itself compares.
std::int64_t visited(const Bvh& tree, std::size_t level, std::size_t a, std::size_t b) {
  if (level == 0) return 1;
  const LargeArray<PackedBox>& below = tree.levels()[level - 1].boxes;
  std::int64_t sum = 1;
  for (std::size_t i = Bvh::width * a; i < std::min(below.size(), Bvh::width * (a + 1)); ++i)
    for (std::size_t j = a == b ? i : Bvh::width * b; j < std::min(below.size(), Bvh::width * (b + 1)); ++j)
      if (may_meet(below[i], below[j])) sum += visited(tree, level - 1, i, j);
  return sum;
}

std::int64_t visited(const Bvh& tree) { return visited(tree, tree.levels().size() - 1, 0, 0); }

std::vector<std::pair<Index, Index>> pairs(const Bvh& tree) {
  std::vector<std::pair<Index, Index>> found = Bvh::overlapping_pairs(tree, Execution(1));
  for (auto& [i, j] : found)
    if (i > j) std::swap(i, j);
  std::sort(found.begin(), found.end());
  return found;
}

/// A tree that is built at `first` and then updated to `second`.
struct Kept {
  Kept(const Positions& first, const Positions& second)
      : surface(loose_triangles()), swept(*surface), tree(*surface, surface->triangles().data(), count) {
    update(first);
    before = tree.tree();
    update(second);
    unchanged = before;
    unchanged->refit([&](Index face) { return swept.box_of(corners(face)); }, Execution(1));
  }

  void update(const Positions& q) {
    Positions end = q;
    for (Index row = 0; row < end.rows(); row += 2) end(row, 2) += 1e-3;  // vertices at rest are ignored
    const Step step{q, end, {0.01, 0.5}};
    swept.update(step, Execution(1), SweptVertices::Reuse::forbidden);
    tree.update(step, swept, SweptVertices::Change::all, tree.is_spoiled(q), Execution(1));
  }

  std::span<const Index, 3> corners(Index face) const {
    return std::span<const Index, 3>(surface->triangles().data() + 3 * face, 3);
  }

  std::shared_ptr<const Surface> surface;
  SweptVertices swept;
  PrimitiveTree<3> tree;
  std::optional<Bvh> before, unchanged;  // its first tree, and a copy of that refitted instead
};

}  // namespace

TEST_CASE("primitive tree: built again once neighbours are apart, which leaves a fraction of the nodes to visit") {
  const Kept kept(placed(in_order()), placed(shuffled()));
  CHECK(kept.tree.tree().order() != kept.before->order());
  CHECK(pairs(kept.tree.tree()) == pairs(*kept.unchanged));
  const std::int64_t fresh = visited(kept.tree.tree()), stale = visited(*kept.unchanged);
  MESSAGE(fresh << " pairs of nodes instead of " << stale << " for " << count << " triangles");
  CHECK(10 * fresh < stale);
  // Building a tree is a sort, which takes about this many comparisons of single numbers. A pair of nodes takes up to
  // 64 comparisons of boxes.
  CHECK(stale - fresh > 1.0 * count * std::log2(count) / 8);
}

TEST_CASE("primitive tree: kept while neighbours stay together, however far they go") {
  const Positions rest = placed(in_order());
  Positions bent = rest;
  for (Index row = 0; row < bent.rows(); ++row) {  // twisted about an axis, and enlarged
    const double angle = 0.2 * rest(row, 2);
    bent.row(row) << 7 * (std::cos(angle) * rest(row, 0) - std::sin(angle) * rest(row, 1)),
        7 * (std::sin(angle) * rest(row, 0) + std::cos(angle) * rest(row, 1)), 9 * rest(row, 2) + 100;
  }
  const Kept kept(rest, bent);
  CHECK(kept.tree.tree().order() == kept.before->order());
  CHECK(pairs(kept.tree.tree()) == pairs(*kept.unchanged));
}

TEST_CASE(
    "primitive tree: a body carried past one at rest, by many edges, has the pairs of edges that it has at rest") {
  const auto pairs_of_edges = [](const Vector3& displacement, bool own_frames) {
    const MovingScene scene = carried_sheets(20, {Vector3::Zero(), displacement}, 1e-4, 1);
    const Surface& surface = *scene.surface;
    Step step{scene.start, scene.end, {1e-4, 0.5}};
    if (own_frames) step.motions = FrameChooser(surface, 1).choose(scene.start, scene.end);
    SweptVertices swept(surface);
    const Execution execution(1);
    PrimitiveTree<2> edges(surface, surface.edges().data(), static_cast<Index>(surface.edges().rows()));
    edges.update(step, swept, swept.update(step, execution), false, execution);
    const GroupRelations bodies{{}, swept.body_frames()};
    PairBuffer found;
    for (const Bvh::Task& task : edges.tree().tasks(edges.tree(), bodies))
      edges.tree().overlaps(task, edges.tree(), bodies, found);
    return static_cast<double>(found.count);
  };
  const Vector3 hardly(1e-4, 0, 0), away(0.5, -0.4, 0.3);
  CHECK(pairs_of_edges(hardly, true) > 1000);
  CHECK(pairs_of_edges(away, true) < 1.1 * pairs_of_edges(hardly, true));  // of the slack
  CHECK(pairs_of_edges(away, false) > 10 * pairs_of_edges(away, true));
}

TEST_CASE("primitive tree: pairs of a traversal come with their corners, and so do places behind the last one") {
  const MovingScene scene = stirred_sheets(20, 2, 0.1, 3);
  const Surface& surface = *scene.surface;
  const Step step{scene.start, scene.end, {1e-4}};
  SweptVertices swept(surface);
  const Execution execution(1);
  const SweptVertices::Change change = swept.update(step, execution);
  std::vector<Index> numbers(static_cast<std::size_t>(surface.vertex_count()));
  std::iota(numbers.begin(), numbers.end(), 0);
  PrimitiveTree<1> vertices(surface, numbers.data(), surface.vertex_count());
  PrimitiveTree<2> edges(surface, surface.edges().data(), static_cast<Index>(surface.edges().rows()));
  PrimitiveTree<3> faces(surface, surface.triangles().data(), static_cast<Index>(surface.triangles().rows()));
  vertices.update(step, swept, change, false, execution);
  edges.update(step, swept, change, false, execution);
  faces.update(step, swept, change, false, execution);
  const auto check = [&](EventKind kind, const Bvh& a, const Bvh& b) {
    PairBuffer found;
    for (const Bvh::Task& task : a.tasks(b, {})) a.overlaps(task, b, {}, found);
    CHECK(found.count > 1000);
    for (std::size_t pair = 0; pair < found.count; ++pair) {
      const std::array<Index, 4> expected = vertices_of(surface, kind, found[pair]);
      for (std::size_t k = 0; k < 4; ++k) CHECK(found.corners[k][pair] == expected[k]);
    }
    for (const std::vector<Index>& corners : found.corners) {
      REQUIRE(corners.size() >= found.count + Bvh::width);
      CHECK(*std::min_element(corners.begin(), corners.end()) >= 0);
      CHECK(*std::max_element(corners.begin(), corners.end()) < surface.vertex_count());
    }
  };
  check(EventKind::vertex_face, vertices.tree(), faces.tree());
  check(EventKind::edge_edge, edges.tree(), edges.tree());
}
