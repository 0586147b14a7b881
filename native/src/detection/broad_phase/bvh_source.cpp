// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <numeric>
#include <utility>

#include "detection/broad_phase/candidate_source.hpp"
#include "detection/broad_phase/primitive_tree.hpp"
#include "detection/broad_phase/relevance.hpp"
#include "detection/broad_phase/swept_vertices.hpp"
#include "detection/filters/pair_filters.hpp"

namespace stiv {

namespace {

GroupTable table_of_bodies(const Surface& surface) {
  const auto count = static_cast<Index>(surface.bodies().size());
  std::vector<unsigned char> meets;
  bool all = true;
  for (Index a = 0; a < count; ++a)
    for (Index b = 0; b < count; ++b) {
      meets.push_back(surface.bodies_meet(a, b));
      all = all && surface.bodies_meet(a, b);
    }
  return all ? GroupTable() : GroupTable(count, std::move(meets));
}

/// Trees over vertices, edges and faces, built at the first step, and their pairs. Later steps refit and compare only
/// changed primitives.
class BvhSource final : public CandidateSource {
 public:
  explicit BvhSource(const Surface& surface)
      : surface_(surface),
        bodies_{table_of_bodies(surface)},
        swept_(surface),
        numbers_(surface.vertex_count()),
        vertices_(surface, numbers_.data(), surface.vertex_count()),
        edges_(surface, surface.edges().data(), static_cast<Index>(surface.edges().rows()), &vertices_),
        faces_(surface, surface.triangles().data(), static_cast<Index>(surface.triangles().rows()), &vertices_) {
    std::iota(numbers_.begin(), numbers_.end(), 0);
  }

  void prepare(const Step& still, const Execution& execution) override {
    vertices_.prepare(still.start, execution);
    const auto prepare = [&](auto& tree) {
      tree.prepare(still.start, execution);
      tree.prepare_later_updates(swept_.changing());
    };
    execution.for_chunks(2, 1, [&](Index, Index, Index kind) {  // most of a tree is built on one thread
      if (kind == 0)
        prepare(edges_);
      else
        prepare(faces_);
    });
    vertices_.prepare_later_updates(swept_.changing());
    vertices_.drop_curve();
    const bool has_resting = swept_.changing() < surface_.vertex_count();
    if (has_resting && !refitted_) refit(still, SweptVertices::Reuse::forbidden, execution);
  }

  void set_resting(Index count) override { swept_.set_resting(count); }

  void update(const Step& step, const Execution& execution) override {
    separation_ = step.proximity.separation;
    const bool collected = std::exchange(collected_, false);
    const auto reuse = collected ? SweptVertices::Reuse::allowed : SweptVertices::Reuse::forbidden;
    if (refit(step, reuse, execution) == SweptVertices::Change::none) {
      collected_ = true;
      return;
    }
    bodies_.frames = swept_.body_frames();
    collect(execution);
  }

  bool take_short_step(const PositionsView& start, const PositionsView& end, const Execution& execution) override {
    return refitted_ && collected_ && swept_.take_short_step(start, end, execution);
  }

  const VertexSteps& vertex_steps() const override { return swept_.steps(); }

  bool is_within_pair_limit() const override { return collected_; }

  Index chunk_count(EventKind kind) const override {
    return static_cast<Index>(collected_ ? of(kind).fruitful.size() : of(kind).tasks.size());
  }

  void visit(EventKind kind, Index chunk, const Sink& sink) const override {
    if (collected_) {
      const std::vector<Candidate>& near = of(kind).near[of(kind).fruitful[chunk]];
      std::vector<Candidate> batch;
      for (std::size_t begin = 0; begin < near.size(); begin += batch_size) {
        batch.assign(near.begin() + static_cast<std::ptrdiff_t>(begin),
                     near.begin() + static_cast<std::ptrdiff_t>(std::min(near.size(), begin + batch_size)));
        sink(batch);
      }
      return;
    }
    std::vector<Candidate> batch;
    traverse(kind, chunk, [&](PairBuffer& found) {
      batch.clear();
      append_near(kind, found, batch);
      if (!batch.empty()) sink(batch);
      return true;
    });
  }

 private:
  static constexpr std::size_t batch_size = 4096;

  /// Brings the trees up to date. If this is cancelled, the next step starts from scratch.
  SweptVertices::Change refit(const Step& step, SweptVertices::Reuse reuse, const Execution& execution) {
    const bool refitted = std::exchange(refitted_, false);
    SweptVertices::Change change = swept_.update(step, execution, reuse);
    if (!refitted) change = SweptVertices::Change::all;
    if (change != SweptVertices::Change::none) {
      const auto [edges, faces, vertices] = which_are_spoiled(step.start, change, execution);
      vertices_.update(step, swept_, change, vertices, execution);
      edges_.update(step, swept_, change, edges, execution);
      faces_.update(step, swept_, change, faces, execution);
      vertices_.drop_curve();
    }
    refitted_ = true;
    return change;
  }

  /// The trees of edges, faces and vertices that are to be built again, found at once.
  std::array<bool, 3> which_are_spoiled(const PositionsView& start, SweptVertices::Change change,
                                        const Execution& execution) const {
    std::array<bool, 3> spoiled{};
    if (change != SweptVertices::Change::all) return spoiled;
    execution.for_chunks(3, 1, [&](Index, Index, Index tree) {
      spoiled[at(tree)] = tree == 0   ? edges_.is_spoiled(start)
                          : tree == 1 ? faces_.is_spoiled(start)
                                      : vertices_.is_spoiled(start);
    });
    return spoiled;
  }

  /// Tasks of one kind and their results.
  struct Pairs {
    std::vector<Bvh::Task> tasks;
    std::vector<std::vector<Candidate>> near;
    std::vector<Index> fruitful;  ///< tasks with any result; few in a local edit
  };

  const Pairs& of(EventKind kind) const { return pairs_[static_cast<std::size_t>(kind)]; }
  const Bvh& first_tree(EventKind kind) const {
    return kind == EventKind::vertex_face ? vertices_.tree() : edges_.tree();
  }
  const Bvh& second_tree(EventKind kind) const {
    return kind == EventKind::vertex_face ? faces_.tree() : edges_.tree();
  }

  /// Traverses the trees and caches the pairs. If they are too many to cache, each visit traverses again.
  void collect(const Execution& execution) {
    execution.for_chunks(2, 1, [&](Index, Index, Index number) {
      const auto kind = static_cast<EventKind>(number);
      Pairs& pairs = pairs_[at(number)];
      pairs.near = {};  // before the next pairs are found, since both together would be a peak of memory
      pairs.tasks = first_tree(kind).tasks(second_tree(kind), bodies_);
      pairs.near.resize(pairs.tasks.size());
    });
    compared_ = near_ = compared_coarsely_ = left_coarsely_ = 0;
    const auto faces = static_cast<Index>(of(EventKind::vertex_face).tasks.size());
    const auto count = faces + static_cast<Index>(of(EventKind::edge_edge).tasks.size());
    execution.for_chunks(count, 1, [&](Index task, Index, Index) {
      if (task < faces)
        collect(EventKind::vertex_face, task);
      else
        collect(EventKind::edge_edge, task - faces);
    });
    collected_ = few_enough();
    for (Pairs& pairs : pairs_) {
      if (!collected_) pairs.near.clear();
      pairs.fruitful.clear();
      for (std::size_t task = 0; task < pairs.near.size(); ++task)
        if (!pairs.near[task].empty()) pairs.fruitful.push_back(static_cast<Index>(task));
    }
  }

  void collect(EventKind kind, Index task) {
    if (!few_enough()) return;
    static thread_local std::vector<Candidate> near;  // to keep the pairs in exactly the memory that they need
    near.clear();
    traverse(kind, task, [&](PairBuffer& found) {
      const std::size_t before = near.size();
      compared_ += static_cast<std::int64_t>(found.count);
      append_near(kind, found, near);
      near_ += static_cast<std::int64_t>(near.size() - before);
      return few_enough();
    });
    pairs_[static_cast<std::size_t>(kind)].near[task] = near;
  }

  /// Calls `take(batch)` with the pairs of a task, batch by batch, until it returns false.
  template <class Take>
  void traverse(EventKind kind, Index task, const Take& take) const {
    static thread_local PairBuffer found;  // a step has hundreds of tasks, most of them with few pairs
    found.count = 0;
    found.limit = batch_size;
    found.full = [&](PairBuffer& some) {
      const bool more = take(some);
      some.count = 0;
      return more;
    };
    first_tree(kind).overlaps(of(kind).tasks[task], second_tree(kind), bodies_, found);
    if (found.count > 0) take(found);
    found.full = nullptr;
  }

  static PairView view(const PairBuffer& found, std::size_t begin, std::size_t count) {
    const auto& corners = found.corners;
    return {{&corners[0][begin], &corners[1][begin], &corners[2][begin], &corners[3][begin]}, count};
  }

  /// Pairs from `begin` on, few enough for a filter, that share a frame; and its motion.
  PairView view_of_frame(const PairBuffer& found, std::size_t begin, Vector3& motion) const {
    const auto& corners = found.corners;
    const FrameMotions& motions = swept_.motions();
    std::size_t count = std::min(found.count - begin, PairBlock::capacity);
    motion = motions.common;
    if (motions.has_own_frames()) {
      const auto motion_of = [&](std::size_t pair) -> const Vector3& {
        return motions.of_pair(surface_.body_of(corners[0][pair]), surface_.body_of(corners[3][pair]));
      };
      motion = motion_of(begin);
      std::size_t same = 1;
      while (same < count && motion_of(begin + same) == motion) ++same;
      count = same;
    }
    return view(found, begin, count);
  }

  /// Removes pairs that the filter of `append_near` would drop too: most of them, in half of its time.
  void drop_coarsely_apart(EventKind kind, PairBuffer& found) const {
    if (swept_.motions().has_own_frames() || !swept_.coarse_frame().is_valid() || is_coarse_filter_useless()) return;
    const CoarseBounds bounds = swept_.coarse_bounds();
    std::size_t left = 0;
    for (std::size_t begin = 0; begin < found.count; begin += PairBlock::capacity) {
      const PairView pairs = view(found, begin, std::min(found.count - begin, PairBlock::capacity));
      std::uint64_t near = ~find_apart_by_coarse_hulls(kind, pairs, swept_.coarse_steps().data(), bounds);
      for (near &= ~std::uint64_t{0} >> (64 - pairs.count); near != 0; near &= near - 1) {
        const std::size_t k = begin + static_cast<std::size_t>(std::countr_zero(near));
        found.first[left] = found.first[k];
        found.second[left] = found.second[k];
        for (std::vector<Index>& corner : found.corners) corner[left] = corner[k];
        ++left;
      }
    }
    compared_coarsely_ += static_cast<std::int64_t>(found.count);
    left_coarsely_ += static_cast<std::int64_t>(left);
    found.count = left;
  }

  /// Does the coarse filter leave more than a third of this step's pairs, and thus cost more than it saves? The result
  /// of a search does not depend on it.
  bool is_coarse_filter_useless() const {
    constexpr std::int64_t some = 1024;
    return left_coarsely_ > some && 3 * left_coarsely_ > compared_coarsely_;
  }

  /// Repeats the last pair's corners where vector code reads beyond it. A search of another surface may have left
  /// numbers there that this one does not have.
  static void pad_corners(PairBuffer& found) {
    if (found.count == 0) return;
    for (std::vector<Index>& corner : found.corners)
      std::fill_n(corner.begin() + static_cast<std::ptrdiff_t>(found.count), Bvh::width, corner[found.count - 1]);
  }

  /// Appends the pairs that may interfere in this step or in a nearby one. Removes others from the buffer.
  void append_near(EventKind kind, PairBuffer& found, std::vector<Candidate>& near) const {
    drop_coarsely_apart(kind, found);
    pad_corners(found);
    NearbySteps steps{Vector3::Zero(), separation_, SweptVertices::slack};
    PairFlags apart;
    std::array<Candidate, PairBlock::capacity> some;
    for (std::size_t begin = 0, size; begin < found.count; begin += size) {
      const PairView pairs = view_of_frame(found, begin, steps.motion);
      size = pairs.count;
      find_apart_by_hulls(kind, pairs, swept_.steps(), steps, apart);
      std::size_t count = 0;
      for (std::size_t k = 0; k < size; ++k) {
        some[count] = found[begin + k];
        count += apart[k] == 0;
      }
      near.insert(near.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
    }
    if (surface_.has_flip_faces())
      std::erase_if(
          near, [&](const Candidate& pair) { return surface_.in_one_flip_face(vertices_of(surface_, kind, pair)); });
  }

  /// Dense scenes compare four pairs for each primitive and cache three. These bounds mean a fraction of a second, and
  /// less memory than the trees. Counts only grow, so exceeding a bound does not depend on the order of threads.
  bool few_enough() const {
    const std::int64_t primitives = surface_.vertex_count() + surface_.edges().rows() + surface_.triangles().rows();
    return compared_ <= std::max<std::int64_t>(1 << 21, 16 * primitives) &&
           near_ <= std::max<std::int64_t>(1 << 18, 4 * primitives);
  }

  const Surface& surface_;
  GroupRelations bodies_;
  SweptVertices swept_;
  double separation_ = 0;
  std::vector<Index> numbers_;  // of the vertices: their rows
  PrimitiveTree<1> vertices_;
  PrimitiveTree<2> edges_;
  PrimitiveTree<3> faces_;
  std::array<Pairs, 2> pairs_;
  std::atomic<std::int64_t> compared_{0}, near_{0};                            // pairs so far in this step
  mutable std::atomic<std::int64_t> compared_coarsely_{0}, left_coarsely_{0};  // by the coarse filter
  bool refitted_ = false;                                                      // the trees match the boxes
  bool collected_ = false;                                                     // the cached pairs are complete
};

}  // namespace

std::unique_ptr<CandidateSource> make_bvh_source(const Surface& surface) {
  return std::make_unique<BvhSource>(surface);
}

}  // namespace stiv
