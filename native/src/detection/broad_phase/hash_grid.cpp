// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>

#include "detection/broad_phase/cell_lists.hpp"
#include "detection/broad_phase/relevance.hpp"
#include "detection/broad_phase/swept_vertices.hpp"

namespace stiv {

namespace {

/// Passes candidates on in batches, so that memory does not grow with their number.
class Batches {
 public:
  Batches(EventKind kind, const Relevance& relevance, const CandidateSource::Sink& sink)
      : kind_(kind), relevance_(relevance), sink_(sink) {
    batch_.reserve(size);
  }

  void add(const Candidate& candidate) {
    batch_.push_back(candidate);
    if (batch_.size() == size) hand_out();
  }

  void hand_out() {
    if (!batch_.empty()) sink_(relevance_.select(kind_, batch_));
    batch_.clear();
  }

 private:
  static constexpr std::size_t size = 4096;

  EventKind kind_;
  const Relevance& relevance_;
  const CandidateSource::Sink& sink_;
  std::vector<Candidate> batch_;
};

/// Uniform grid of hashed cells. A pair is reported by the first cell that both boxes reach. Source: Teschner,
/// Heidelberger, Müller, Pomeranets, Gross, "Optimized Spatial Hashing for Collision Detection of Deformable Objects",
/// VMV 2003; there for tetrahedra, with cells of the mean size of an edge.
class HashGrid final : public CandidateSource {
 public:
  explicit HashGrid(const Surface& surface) : surface_(surface), swept_(surface) {}

  void update(const Step& step, const Execution& execution) override {
    Step in_common_frame = step;
    in_common_frame.motions.of_bodies.clear();  // cells know no bodies
    swept_.update(in_common_frame, execution);
    relevance_.emplace(surface_, step);
    const std::vector<Bounds> faces = bounds_of(surface_.triangles()), edges = bounds_of(surface_.edges());
    std::vector<Bounds> vertices;
    for (const PackedBox& box : swept_.boxes()) vertices.push_back(box.bounds());
    const Cells cells = fitting_cells(faces, vertices);
    faces_ = CellLists(cells, faces);
    vertices_ = CellLists(cells, vertices);
    edges_ = CellLists(fitting_cells(edges), edges);
  }

  const VertexSteps& vertex_steps() const override { return swept_.steps(); }

  Index chunk_count(EventKind kind) const override {
    return Execution::chunk_count(queries(kind).bucket_count(), buckets_per_chunk);
  }

  void visit(EventKind kind, Index chunk, const Sink& sink) const override {
    Batches batches(kind, *relevance_, sink);
    const Index end = std::min(queries(kind).bucket_count(), (chunk + 1) * buckets_per_chunk);
    for (Index bucket = chunk * buckets_per_chunk; bucket < end; ++bucket)
      if (kind == EventKind::vertex_face)
        meet(bucket, vertices_, faces_, batches);
      else
        meet(bucket, edges_, edges_, batches);
    batches.hand_out();
  }

 private:
  static constexpr Index buckets_per_chunk = 1024;

  const CellLists& queries(EventKind kind) const { return kind == EventKind::vertex_face ? vertices_ : edges_; }

  /// Entries of one bucket with those of the same cells among `others`.
  static void meet(Index bucket, const CellLists& queries, const CellLists& others, Batches& batches) {
    const bool within = &queries == &others;
    const std::span<const CellEntry> entries = queries.bucket(bucket);
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const CellEntry& entry = entries[k];
      const std::span<const CellEntry> near = within ? entries.subspan(k + 1) : others.bucket_of(entry.cell);
      for (const CellEntry& other : near)
        if (other.cell == entry.cell && overlap(entry.box, other.box) &&
            entry.cell == first_common_cell(entry.first_cell, other.first_cell))
          batches.add({entry.primitive, other.primitive});
    }
  }

  template <class Rows>
  std::vector<Bounds> bounds_of(const Rows& rows) const {
    std::vector<Bounds> boxes;
    for (const auto& row : rows.rowwise()) boxes.push_back(swept_.box_of(row).bounds());
    return boxes;
  }

  const Surface& surface_;
  SweptVertices swept_;
  std::optional<Relevance> relevance_;
  CellLists vertices_, faces_, edges_;
};

}  // namespace

std::unique_ptr<CandidateSource> make_hash_grid(const Surface& surface) { return std::make_unique<HashGrid>(surface); }

}  // namespace stiv
