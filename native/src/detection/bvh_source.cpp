// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <optional>

#include "detection/candidates.hpp"
#include "detection/incidence.hpp"
#include "detection/relevance.hpp"
#include "detection/swept_vertices.hpp"

namespace stiv {

namespace {

std::size_t at(Index index) { return static_cast<std::size_t>(index); }

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

/// Primitives of one kind as rows of vertices, with a tree over them.
class PrimitiveTree {
 public:
  /// @param rows (n, size), alive as long as this
  PrimitiveTree(const Surface& surface, const Index* rows, Index count, Index size)
      : surface_(surface), rows_(rows), count_(count), size_(size) {}

  /// Brings the boxes up to date after `change` of the vertices' boxes.
  void update(const SweptVertices& swept, SweptVertices::Change change, const Execution& execution) {
    const auto box_of = [&](Index primitive) { return swept.box_of(row(primitive)); };
    if (!tree_) build(box_of);
    if (change == SweptVertices::Change::all) {
      tree_->refit(box_of, execution);
    } else if (change == SweptVertices::Change::some) {
      if (!incidence_) incidence_.emplace(rows_, count_, size_, surface_.vertex_count());
      tree_->refit_some(incidence_->rows_with(swept.changed()), box_of);
    }
  }

  const Bvh& tree() const { return *tree_; }

 private:
  std::span<const Index> row(Index primitive) const {
    return {rows_ + static_cast<std::ptrdiff_t>(primitive) * size_, at(size_)};
  }

  template <class BoxOf>
  void build(const BoxOf& box_of) {
    std::vector<Bounds> boxes(at(count_));
    std::vector<Index> bodies(at(count_));
    for (Index primitive = 0; primitive < count_; ++primitive) {
      boxes[at(primitive)] = box_of(primitive).bounds();
      bodies[at(primitive)] = surface_.body_of(row(primitive)[0]);
    }
    tree_.emplace(boxes, bodies, CornerRows{rows_, size_});
  }

  const Surface& surface_;
  const Index* rows_;
  Index count_, size_;
  std::optional<Bvh> tree_;
  std::optional<Incidence> incidence_;
};

/// Trees over vertices, edges and faces, and the pairs that they gave: built at the first step; at the others, what
/// did not change is neither refitted nor compared again.
class BvhSource final : public CandidateSource {
 public:
  explicit BvhSource(const Surface& surface)
      : surface_(surface),
        bodies_(table_of_bodies(surface)),
        swept_(surface),
        numbers_(at(surface.vertex_count())),
        vertices_(surface, numbers_.data(), surface.vertex_count(), 1),
        edges_(surface, surface.edges().data(), static_cast<Index>(surface.edges().rows()), 2),
        faces_(surface, surface.triangles().data(), static_cast<Index>(surface.triangles().rows()), 3) {
    std::iota(numbers_.begin(), numbers_.end(), 0);
  }

  void update(const Step& step, const Execution& execution) override {
    const SweptVertices::Change change = swept_.update(step, execution);
    if (change == SweptVertices::Change::none && collected_) return;
    for (PrimitiveTree* primitives : {&vertices_, &edges_, &faces_}) primitives->update(swept_, change, execution);
    collect(execution);
  }

  Index chunk_count(EventKind kind) const override { return static_cast<Index>(of(kind).tasks.size()); }

  void visit(EventKind kind, Index chunk, const Sink& sink) const override {
    std::vector<Candidate> batch;
    batch.reserve(batch_size);
    if (collected_) {
      hand_out(kind, of(kind).found[at(chunk)], batch, sink);
      return;
    }
    PairBuffer found;
    found.limit = batch_size;
    found.full = [&](PairBuffer& some) {
      hand_out(kind, some, batch, sink);
      some.count = 0;
      return true;
    };
    first_tree(kind).overlaps(of(kind).tasks[at(chunk)], second_tree(kind), bodies_, found);
    found.full(found);
  }

 private:
  static constexpr std::size_t batch_size = 4096;

  /// Work of one kind, and what it gave.
  struct Pairs {
    std::vector<Bvh::Task> tasks;
    std::vector<PairBuffer> found;
  };

  const Pairs& of(EventKind kind) const { return pairs_[static_cast<std::size_t>(kind)]; }
  const Bvh& first_tree(EventKind kind) const {
    return kind == EventKind::vertex_face ? vertices_.tree() : edges_.tree();
  }
  const Bvh& second_tree(EventKind kind) const {
    return kind == EventKind::vertex_face ? faces_.tree() : edges_.tree();
  }

  /// Traverses the trees and keeps the pairs, unless they are too many to be kept: then each visit traverses again.
  void collect(const Execution& execution) {
    for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge}) {
      Pairs& pairs = pairs_[static_cast<std::size_t>(kind)];
      pairs.tasks = first_tree(kind).tasks(second_tree(kind), bodies_);
      pairs.found.resize(std::max(pairs.found.size(), pairs.tasks.size()));
    }
    std::atomic<std::int64_t> total{0};
    const Index faces = chunk_count(EventKind::vertex_face);
    const Index count = faces + chunk_count(EventKind::edge_edge);
    execution.for_chunks(count, 1, [&](Index task, Index, Index) {
      if (task < faces)
        collect(EventKind::vertex_face, task, total);
      else
        collect(EventKind::edge_edge, task - faces, total);
    });
    collected_ = total <= most_pairs();
    if (!collected_)
      for (Pairs& pairs : pairs_) pairs.found.clear();
  }

  void collect(EventKind kind, Index task, std::atomic<std::int64_t>& total) {
    PairBuffer& found = pairs_[static_cast<std::size_t>(kind)].found[at(task)];
    std::size_t counted = 0;
    found.count = 0;
    found.limit = batch_size;
    found.full = [&](PairBuffer& some) {
      total += static_cast<std::int64_t>(some.count - counted);
      counted = some.count;
      some.limit = counted + batch_size;
      return total <= most_pairs();
    };
    first_tree(kind).overlaps(of(kind).tasks[at(task)], second_tree(kind), bodies_, found);
    found.full(found);
    found.full = nullptr;
  }

  /// Pairs are kept up to 64 a primitive, which takes as much memory as the trees several times over.
  std::int64_t most_pairs() const {
    const std::int64_t primitives = surface_.vertex_count() + surface_.edges().rows() + surface_.triangles().rows();
    return std::max<std::int64_t>(1 << 20, 16 * primitives);
  }

  void hand_out(EventKind kind, const PairBuffer& found, std::vector<Candidate>& batch, const Sink& sink) const {
    for (std::size_t begin = 0; begin < found.count; begin += batch_size) {
      const std::size_t end = std::min(found.count, begin + batch_size);
      batch.clear();
      for (std::size_t k = begin; k < end; ++k)
        if (!surface_.has_recut_faces() || !surface_.in_one_recut_face(vertices_of(surface_, kind, found[k])))
          batch.push_back(found[k]);
      if (!batch.empty()) sink(batch);
    }
  }

  const Surface& surface_;
  GroupTable bodies_;
  SweptVertices swept_;
  std::vector<Index> numbers_;  // of the vertices: their rows
  PrimitiveTree vertices_, edges_, faces_;
  std::array<Pairs, 2> pairs_;
  bool collected_ = false;
};

}  // namespace

std::unique_ptr<CandidateSource> make_bvh_source(const Surface& surface) {
  return std::make_unique<BvhSource>(surface);
}

}  // namespace stiv
