// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/acceptance/intersections.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <utility>

#include "acceptance/clearance/triangle_distance.hpp"
#include "acceptance/intersection/candidate_test.hpp"
#include "acceptance/intersection/near_pair_list.hpp"
#include "acceptance/intersection/placed_vertices.hpp"
#include "acceptance/intersection/primitives.hpp"
#include "acceptance/intersection/stars.hpp"

namespace stiv {

namespace {

GroupRelations pairs_of_bodies(const Surface& surface) {
  const auto count = static_cast<Index>(surface.bodies().size());
  std::vector<unsigned char> tested;
  for (Index a = 0; a < count; ++a)
    for (Index b = 0; b < count; ++b) tested.push_back(surface.bodies_meet(a, b));
  return {GroupTable(count, std::move(tested)), {}};
}

/// Triangles of bodies that are tested against themselves. Of the others, no pair of neighbors is a candidate.
CornerList corners_within_tested_bodies(const Surface& surface, const CornerList& triangles) {
  CornerList some;
  for (const auto& corners : triangles) {
    const Index body = surface.body_of(corners[0]);
    if (surface.bodies_meet(body, body)) some.push_back(corners);
  }
  return some;
}

/// Finds primitives by their corners, in any order.
class PrimitiveNumbers {
 public:
  explicit PrimitiveNumbers(const CornerList& all) {
    for (const auto& corners : all) rows_.emplace_back(sorted(corners), static_cast<Index>(rows_.size()));
    std::sort(rows_.begin(), rows_.end());
  }

  Index of(const std::array<Index, 3>& corners) const {
    return std::lower_bound(rows_.begin(), rows_.end(), std::pair(sorted(corners), Index{0}))->second;
  }

 private:
  static std::array<Index, 3> sorted(std::array<Index, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  std::vector<std::pair<std::array<Index, 3>, Index>> rows_;
};

/// The distance of a loose edge or vertex, whose last corner repeats, and a triangle. Infinite if an edge has both
/// vertices in common with the triangle.
double loose_distance(const CornerPair& pair, const PositionsView& q) {
  const auto& [a, b, repeated] = pair.first;
  const auto is_corner = [&](Index vertex) { return std::ranges::find(pair.second, vertex) != pair.second.end(); };
  if (is_corner(a) && is_corner(b)) return std::numeric_limits<double>::infinity();
  return is_corner(a) ? distance_apart({b, b, a}, pair.second, q) : distance_apart({a, a, b}, pair.second, q);
}

/// Searches for intersections of two kinds of primitives, or of one kind with itself.
class Search {
 public:
  /// @param reach of the pairs to list; nothing: lists none
  Search(const Surface& surface, const Primitives& first, const Primitives& second, const GroupRelations& bodies,
         const PositionsView& q, const PackedPoints& points, std::optional<double> reach)
      : surface_(surface), first_(first), second_(second), bodies_(bodies), q_(q), points_(points) {
    if (!first_.empty() && !second_.empty()) tasks_ = first_.tree().tasks(second_.tree(), bodies_);
    if (reach) near_.resize(tasks_.size(), {*reach, {}, {}});
  }

  /// Appends the pairs that the whole search listed.
  void append_near(std::vector<CornerPair>& pairs) const {
    for (const NearPairs& near : near_) pairs.insert(pairs.end(), near.pairs.begin(), near.pairs.end());
  }

  IndexPairs all(const Execution& execution) {
    std::vector<IndexPairs> found(tasks_.size());
    execution.for_chunks(static_cast<Index>(tasks_.size()), 1, [&](Index, Index, Index task) {
      scan(task, [&](const PrimitivePair& pair) {
        found[at(task)].emplace_back(pair.first, pair.second);
        return true;
      });
    });
    return sorted(found);
  }

  bool any(const Execution& execution) {
    std::atomic<bool> found{false};
    execution.for_chunks(static_cast<Index>(tasks_.size()), 1, [&](Index, Index, Index task) {
      if (found.load(std::memory_order_relaxed)) return;
      scan(task, [&](const PrimitivePair&) {
        found.store(true, std::memory_order_relaxed);
        return false;
      });
    });
    return found;
  }

 private:
  /// Calls `report(pair)` for each intersection until it returns false.
  template <class Report>
  void scan(Index task, const Report& report) {
    NearPairs* const near = near_.empty() ? nullptr : &near_[at(task)];
    CandidateTest test(surface_, q_, points_, near, report);
    PairBuffer candidates;
    bool more = true;
    candidates.limit = 4096;
    candidates.full = [&](PairBuffer& found) {
      for (std::size_t k = 0; k < found.count && more; ++k)
        more = test.add(found[k], first_.corners(found.first[k]), second_.corners(found.second[k]));
      found.count = 0;
      return more;
    };
    first_.tree().overlaps(tasks_[at(task)], second_.tree(), bodies_, candidates);
    if (candidates.full(candidates)) test.finish();
  }

  IndexPairs sorted(const std::vector<IndexPairs>& found) const {
    IndexPairs pairs;
    for (const IndexPairs& chunk : found) pairs.insert(pairs.end(), chunk.begin(), chunk.end());
    if (&first_ == &second_)
      for (auto& [a, b] : pairs)
        if (b < a) std::swap(a, b);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }

  const Surface& surface_;
  const Primitives &first_, &second_;
  const GroupRelations& bodies_;
  PositionsView q_;
  const PackedPoints& points_;
  std::vector<Bvh::Task> tasks_;
  std::vector<NearPairs> near_;  // of each task
};

}  // namespace

class IntersectionTest::Implementation {
 public:
  Implementation(std::shared_ptr<const Surface> surface, IntersectionTestOptions options)
      : surface_(std::move(surface)),
        triangles_(*surface_, triangle_corners(*surface_)),
        loose_edges_(*surface_, loose_edge_corners(*surface_)),
        loose_vertices_(*surface_, loose_vertex_corners(*surface_)),
        stars_(std::make_shared<const Stars>(corners_within_tested_bodies(*surface_, triangles_.all_corners()),
                                             surface_->vertex_count())),
        bodies_(pairs_of_bodies(*surface_)),
        resting_(options.resting) {
    if (options.lists_near_pairs) near_.emplace(surface_, stars_);
  }

  IndexPairs find(const PositionsView& q, const Execution& execution) {
    check_positions(q, execution);
    update({&triangles_}, q, {}, execution);
    return begin_search(triangles_, q).all(execution);
  }

  StaticPairs find_all(const PositionsView& q, const Execution& execution) {
    check_positions(q, execution);
    if (near_) near_->begin(q, {}, execution);
    update({&triangles_, &loose_edges_, &loose_vertices_}, q, {}, execution);
    NearPairList::Found listed;
    StaticPairs found;
    found.faces = find_among(triangles_, q, listed.triangles, execution);
    found.loose_edges = find_among(loose_edges_, q, listed.loose, execution);
    found.loose_vertices = numbered(find_among(loose_vertices_, q, listed.loose, execution));
    if (near_ && found.empty()) near_->accept(q, {}, listed, proofs_, execution);
    return found;
  }

  IndexPairs find_near(const PositionsView& q, double distance, const Execution& execution) {
    check_positions(q, execution);
    near_->begin(q, {}, execution, distance);
    update({&triangles_}, q, {}, execution);
    std::vector<CornerPair> listed;
    find_among(triangles_, q, listed, execution);
    for (const Index vertex : stars_->find_open(proofs_, {}))  // searches leave out those that are free at q
      stars_->any_pair(vertex, [&](const CornerPair& pair) {
        listed.push_back(pair);
        return false;
      });
    return numbered(listed);
  }

  StaticPairs find_near_loose(const PositionsView& q, double distance, const Execution& execution) {
    check_positions(q, execution);
    near_->begin(q, {}, execution, distance);
    update({&triangles_, &loose_edges_, &loose_vertices_}, q, {}, execution);
    const auto find = [&](const Primitives& loose) {
      std::vector<CornerPair> listed;
      IndexPairs found = find_among(loose, q, listed, execution);
      std::erase_if(listed, [&](const CornerPair& pair) { return !(loose_distance(pair, q) < distance); });
      const IndexPairs near = numbered(listed, loose);
      found.insert(found.end(), near.begin(), near.end());
      sort_unique(found);
      return found;
    };
    return {{}, find(loose_edges_), numbered(find(loose_vertices_))};
  }

  bool is_free(const PositionsView& q, const std::vector<unsigned char>& moved, const Execution& execution) {
    check_positions(q, execution);
    NearPairList::Found listed;
    if (!near_) return is_free(q, moved, listed, execution);
    const std::vector<unsigned char> searched = near_->begin(q, moved, execution);
    if (!is_free(q, searched, listed, execution)) return false;
    near_->accept(q, searched, listed, proofs_, execution);
    return true;
  }

  std::shared_ptr<const DeviationTest> deviation_test(const PositionsView& q) const {
    return near_ ? near_->test_near(q) : nullptr;
  }

 private:
  bool is_free(const PositionsView& q, const std::vector<unsigned char>& moved, NearPairList::Found& listed,
               const Execution& execution) {
    update({&triangles_, &loose_edges_, &loose_vertices_}, q, moved, execution);
    const auto meets = [&](const Primitives& first, std::vector<CornerPair>& near) {
      Search search = begin_search(first, q);
      if (search.any(execution)) return true;
      search.append_near(near);
      return false;
    };
    return !meets(triangles_, listed.triangles) && !meets(loose_edges_, listed.loose) &&
           !meets(loose_vertices_, listed.loose);
  }

  IndexPairs find_among(const Primitives& first, const PositionsView& q, std::vector<CornerPair>& near,
                        const Execution& execution) const {
    Search search = begin_search(first, q);
    IndexPairs pairs = search.all(execution);
    search.append_near(near);
    return pairs;
  }

  /// A search of primitives among triangles, after an update.
  Search begin_search(const Primitives& first, const PositionsView& q) const {
    const std::optional<double> reach = near_ ? std::optional(near_->reach()) : std::nullopt;
    return {*surface_, first, triangles_, bodies_, q, placed_->points(), reach};
  }

  IndexPairs numbered(IndexPairs pairs) const {
    for (auto& [vertex, triangle] : pairs) vertex = loose_vertices_.corners(vertex)[0];
    return pairs;
  }

  /// Numbers of the triangles of pairs, smaller number first, sorted.
  IndexPairs numbered(const std::vector<CornerPair>& pairs) const {
    IndexPairs found = numbered(pairs, triangles_);
    for (auto& [first, second] : found)
      if (second < first) std::swap(first, second);
    sort_unique(found);
    return found;
  }

  /// Numbers of the primitives in pairs with triangles.
  IndexPairs numbered(const std::vector<CornerPair>& pairs, const Primitives& first) const {
    if (pairs.empty()) return {};
    const PrimitiveNumbers of_first(first.all_corners()), of_second(triangles_.all_corners());
    IndexPairs found;
    for (const auto& pair : pairs) found.emplace_back(of_first.of(pair.first), of_second.of(pair.second));
    return found;
  }

  void check_positions(const PositionsView& q, const Execution& execution) const {
    constexpr Index chunk_size = 8192;
    if (q.rows() != surface_->vertex_count()) surface_->check_positions(q);
    const Index count = static_cast<Index>(q.rows()) - (placed_ ? resting_ : 0);
    execution.for_chunks(count, chunk_size, [&](Index begin, Index end, Index) {
      for (Index vertex = begin; vertex < end; ++vertex) surface_->check_position(vertex, q.row(vertex));
    });
  }

  using Kinds = std::vector<Primitives*>;

  void update(const Kinds& kinds, const PositionsView& q, const std::vector<unsigned char>& moved,
              const Execution& execution) {
    std::optional<PlacedVertices> placed = std::exchange(placed_, std::nullopt);  // this may be cancelled
    if (!placed) placed.emplace(*surface_, resting_);
    placed->update(q, moved, near_ ? near_->margin() : 0, execution);
    for (Primitives* kind : {&triangles_, &loose_edges_, &loose_vertices_})
      kind->note_changes(placed->changed_bodies());
    for (Primitives* kind : kinds) kind->update(placed->boxes(), execution);
    // Proofs mostly turn out as before. If this was cancelled in between, all bodies have changed.
    const bool are_left_out = std::exchange(free_stars_are_left_out_, false);
    proofs_before_ = proofs_;
    stars_->find_free(*placed, moved, near_ ? near_->reach() : 0, proofs_, execution);
    if (!are_left_out || proofs_ != proofs_before_)
      triangles_.leave_out_neighbours(proofs_, placed->changed_bodies(), execution);
    free_stars_are_left_out_ = true;
    placed_ = std::move(placed);
  }

  std::shared_ptr<const Surface> surface_;
  Primitives triangles_, loose_edges_, loose_vertices_;
  std::shared_ptr<const Stars> stars_;
  GroupRelations bodies_;
  std::optional<PlacedVertices> placed_;               ///< of the last update, unless it was cancelled
  std::vector<unsigned char> proofs_, proofs_before_;  ///< of stars, of the last two updates
  bool free_stars_are_left_out_ = false;               ///< in searches of triangles
  std::optional<NearPairList> near_;                   ///< if it is wanted
  Index resting_;                                      ///< vertices
};

IntersectionTest::IntersectionTest(std::shared_ptr<const Surface> surface, IntersectionTestOptions options)
    : implementation_(std::make_unique<Implementation>(std::move(surface), options)) {}
IntersectionTest::~IntersectionTest() = default;
IntersectionTest::IntersectionTest(IntersectionTest&&) noexcept = default;
IntersectionTest& IntersectionTest::operator=(IntersectionTest&&) noexcept = default;

IndexPairs IntersectionTest::find(const PositionsView& q, Execution& execution) {
  const FloatingPointScope floating_point;
  return implementation_->find(q, execution);
}

StaticPairs IntersectionTest::find_all(const PositionsView& q, Execution& execution) {
  const FloatingPointScope floating_point;
  return implementation_->find_all(q, execution);
}

IndexPairs IntersectionTest::find_near(const PositionsView& q, double distance, Execution& execution) {
  const FloatingPointScope floating_point;
  return implementation_->find_near(q, distance, execution);
}

StaticPairs IntersectionTest::find_near_loose(const PositionsView& q, double distance, Execution& execution) {
  const FloatingPointScope floating_point;
  return implementation_->find_near_loose(q, distance, execution);
}

bool IntersectionTest::is_free(const PositionsView& q, const std::vector<unsigned char>& moved, Execution& execution) {
  const FloatingPointScope floating_point;
  return implementation_->is_free(q, moved, execution);
}

std::shared_ptr<const DeviationTest> IntersectionTest::deviation_test(const PositionsView& q) const {
  return implementation_->deviation_test(q);
}

}  // namespace stiv
