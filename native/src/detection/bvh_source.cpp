// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "detection/relevance.hpp"
#include "detection/swept_bounds.hpp"

namespace stiv {

namespace {

GroupTable table_of_bodies(const Surface& surface) {
  const auto count = static_cast<Index>(surface.bodies().size());
  std::vector<unsigned char> meets;
  for (Index a = 0; a < count; ++a)
    for (Index b = 0; b < count; ++b) meets.push_back(surface.bodies_meet(a, b));
  return {count, std::move(meets)};
}

template <class Corners>
std::vector<Index> bodies_of(const Surface& surface, const Corners& corners) {
  std::vector<Index> bodies(static_cast<std::size_t>(corners.rows()));
  for (Index row = 0; row < corners.rows(); ++row)
    bodies[static_cast<std::size_t>(row)] = surface.body_of(corners(row, 0));
  return bodies;
}

/// Trees over vertices, edges and faces; built at the first step, refitted at the others.
class BvhSource final : public CandidateSource {
 public:
  explicit BvhSource(const Surface& surface) : surface_(surface), bodies_(table_of_bodies(surface)) {}

  void update(const Step& step, const Execution& execution) override {
    sweep_bounds(surface_, step, execution, swept_);
    relevance_.emplace(surface_, step);
    if (!vertices_) build();
    vertices_->refit(swept_.vertices, swept_.vertex_moves);
    edges_->refit(swept_.edges, swept_.edge_moves);
    faces_->refit(swept_.faces, swept_.face_moves);
  }

  Index chunk_count(EventKind kind) const override {
    return Execution::chunk_count(queries(kind).block_count(), blocks_per_chunk);
  }

  void visit(EventKind kind, Index chunk, const Sink& sink) const override {
    const Bvh& tree = kind == EventKind::vertex_face ? *faces_ : *edges_;
    const Index end = std::min(queries(kind).block_count(), (chunk + 1) * blocks_per_chunk);
    PairBuffer found;
    const auto hand_out = [&] {
      sink(relevance_->select(kind, {found.pairs.data(), found.count}));
      found.count = 0;
    };
    for (Index block = chunk * blocks_per_chunk; block < end; ++block) {
      queries(kind).overlaps_of_block(block, tree, bodies_, found);
      if (found.count >= batch_size) hand_out();
    }
    if (found.count > 0) hand_out();
  }

 private:
  static constexpr Index blocks_per_chunk = 32;
  static constexpr std::size_t batch_size = 4096;

  const Bvh& queries(EventKind kind) const { return kind == EventKind::vertex_face ? *vertices_ : *edges_; }

  void build() {
    std::vector<Index> vertex_bodies(static_cast<std::size_t>(surface_.vertex_count()));
    for (Index vertex = 0; vertex < surface_.vertex_count(); ++vertex)
      vertex_bodies[static_cast<std::size_t>(vertex)] = surface_.body_of(vertex);
    vertices_.emplace(swept_.vertices, vertex_bodies);
    edges_.emplace(swept_.edges, bodies_of(surface_, surface_.edges()));
    faces_.emplace(swept_.faces, bodies_of(surface_, surface_.triangles()));
  }

  const Surface& surface_;
  GroupTable bodies_;
  SweptBounds swept_;
  std::optional<Relevance> relevance_;
  std::optional<Bvh> vertices_, edges_, faces_;
};

}  // namespace

std::unique_ptr<CandidateSource> make_bvh_source(const Surface& surface) {
  return std::make_unique<BvhSource>(surface);
}

}  // namespace stiv
