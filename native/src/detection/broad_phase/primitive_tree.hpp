// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "detection/broad_phase/bvh.hpp"
#include "detection/broad_phase/candidate_source.hpp"
#include "detection/broad_phase/swept_vertices.hpp"
#include "detection/primitive_pair.hpp"

namespace stiv {

/// Primitives of one kind as rows of `size` vertices, with a tree over them, rebuilt when a deformation has degraded
/// it.
template <Index size>
class PrimitiveTree {
 public:
  /// @param rows (count, size), which must outlive this
  PrimitiveTree(const Surface& surface, const Index* rows, Index count)
      : surface_(surface), rows_(rows), count_(count) {}

  /// Brings the boxes up to date after `change` of the vertices' boxes.
  void update(const Step& step, const SweptVertices& swept, SweptVertices::Change change, const Execution& execution) {
    if (!tree_ || (change == SweptVertices::Change::all && is_spoiled(step.start))) build(step.start, execution);
    const bool many = swept.changed().size() > static_cast<std::size_t>(surface_.vertex_count()) / few;
    if (change == SweptVertices::Change::all) {
      tree_->refit_corners(swept.boxes(), execution);
    } else if (change == SweptVertices::Change::some && many) {
      tree_->refit_groups_corners(swept.changed_bodies(), swept.boxes(), execution);
    } else if (change == SweptVertices::Change::some) {
      tree_->refit_some_corners(incidence_->primitives_with(swept.changed()), swept.boxes());
    }
  }

  /// Builds the tree that the first update from these positions would build.
  void prepare(const PositionsView& start, const Execution& execution) {
    if (!tree_) build(start, execution);
  }

  const Bvh& tree() const { return *tree_; }

 private:
  /// Below one changed vertex in this many, finding their primitives is faster than refitting all on several threads.
  static constexpr std::size_t few = 16;

  std::span<const Index, static_cast<std::size_t>(size)> row(Index primitive) const {
    return std::span<const Index, static_cast<std::size_t>(size)>(rows_ + static_cast<std::ptrdiff_t>(primitive) * size,
                                                                  static_cast<std::size_t>(size));
  }

  /// Sorted by the start of the step: its end may be anywhere.
  void build(const PositionsView& start, const Execution& execution) {
    constexpr Index chunk_size = 8192;
    std::vector<Eigen::Vector3f> centres(count_);
    std::vector<Index> bodies(count_);
    execution.for_chunks(count_, chunk_size, [&](Index begin, Index end, Index) {
      for (Index primitive = begin; primitive < end; ++primitive) {
        Vector3 sum = Vector3::Zero();
        for (const Index vertex : row(primitive)) sum += (start.row(vertex) - start.row(0)) / size;
        const Eigen::Vector3f centre = sum.cast<float>();
        centres[primitive] = centre.allFinite() ? centre : Eigen::Vector3f(Eigen::Vector3f::Zero());
        bodies[primitive] = surface_.body_of(row(primitive)[0]);
      }
    });
    tree_.emplace(centres, bodies, CornerRows{rows_, size}, execution);
    // Needed only when few vertices move; built here so that memory does not grow late in a session.
    if (!incidence_) incidence_.emplace(rows_, count_, size, surface_.vertex_count());
    spread_ = spread(start);
  }

  /// Mean extent of a sample of blocks, relative to the whole extent. It is constant while neighbors stay together.
  double spread(const PositionsView& start) const {
    constexpr std::size_t stride = 8;
    const std::vector<Index>& order = tree_->order();
    Eigen::AlignedBox3d whole;
    double sum = 0;
    for (std::size_t first = 0; first < order.size(); first += stride * Bvh::width) {
      Eigen::AlignedBox3d block;
      for (std::size_t k = first; k < first + Bvh::width; ++k)
        if (order[k] >= 0) block.extend(Vector3(start.row(row(order[k])[0])));
      sum += block.sizes().sum();
      whole.extend(block);
    }
    const double blocks = static_cast<double>((order.size() / Bvh::width + stride - 1) / stride);
    return sum > 0 ? sum / (blocks * whole.sizes().sum()) : 0;
  }

  /// Has the surface deformed so much that rebuilding pays off?
  bool is_spoiled(const PositionsView& start) const { return spread(start) > 2 * spread_; }

  const Surface& surface_;
  const Index* rows_;
  Index count_;
  std::optional<Bvh> tree_;
  double spread_ = 0;  // when the tree was built
  std::optional<VertexIncidence> incidence_;
};

}  // namespace stiv
