// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "detection/broad_phase/block_order.hpp"
#include "detection/broad_phase/bvh.hpp"
#include "detection/broad_phase/candidate_source.hpp"
#include "detection/broad_phase/corner_order.hpp"
#include "detection/broad_phase/curve_order.hpp"
#include "detection/broad_phase/swept_vertices.hpp"

namespace stiv {

/// Primitives of one kind as rows of `size` vertices, with a tree over them, rebuilt when a deformation has degraded
/// it.
template <Index size>
class PrimitiveTree {
 public:
  /// @param rows (count, size), which must outlive this
  /// @param vertices a tree over the vertices that is updated before this one; its order gives that of the primitives
  PrimitiveTree(const Surface& surface, const Index* rows, Index count, const PrimitiveTree<1>* vertices = nullptr)
      : surface_(surface), rows_(rows), count_(count), vertices_(vertices) {}

  /// Has the surface deformed so much that it pays off to build the tree again? Reads this tree alone.
  bool is_spoiled(const PositionsView& start) const { return tree_ && spread(start) > 2 * spread_; }

  /// Brings the boxes up to date after `change` of the vertices' boxes.
  /// @param spoiled the tree is built again
  void update(const Step& step, const SweptVertices& swept, SweptVertices::Change change, bool spoiled,
              const Execution& execution) {
    // Needed only when few vertices move, never by a first search. Built by the second one at the latest, so that
    // memory does not grow late in a session.
    if (std::exchange(has_boxes_, true)) prepare_later_updates(swept.changing());
    if (!tree_ || spoiled) build(step.start, execution);
    const bool many = swept.changed().size() > static_cast<std::size_t>(surface_.vertex_count()) / few;
    if (change == SweptVertices::Change::all) {
      tree_->refit_corners(swept.boxes(), execution);
    } else if (change == SweptVertices::Change::some && many) {
      tree_->refit_groups_corners(swept.changed_bodies(), swept.boxes(), execution);
    } else if (change == SweptVertices::Change::some) {
      tree_->refit_some_corners(swept.changed(), swept.boxes());
    }
  }

  /// Builds the tree that the first update from these positions would build.
  void prepare(const PositionsView& start, const Execution& execution) {
    if (!tree_) build(start, execution);
  }
  /// Allocates what the second update would allocate, if only the first vertices ever change.
  void prepare_later_updates(Index changing) { tree_->prepare_refit_some_corners(changing); }

  const Bvh& tree() const { return *tree_; }

  /// The vertices when their tree was built, for the first trees over their primitives.
  struct Curve {
    NumberedPoints points;     ///< see points_at
    LargeArray<Index> places;  ///< of each vertex along a space-filling curve
  };
  const Curve& curve() const { return curve_; }
  /// Frees the memory, once those trees are built.
  void drop_curve() { curve_ = {}; }

 private:
  /// Below one changed vertex in this many, finding their primitives is faster than refitting those of their bodies on
  /// several threads.
  static constexpr std::size_t few = 16;
  static constexpr Index chunk_size = 8192;

  std::span<const Index, static_cast<std::size_t>(size)> row(Index primitive) const {
    return std::span<const Index, static_cast<std::size_t>(size)>(rows_ + static_cast<std::ptrdiff_t>(primitive) * size,
                                                                  static_cast<std::size_t>(size));
  }

  /// Sorted by the start of the step: its end may be anywhere.
  void build(const PositionsView& start, const Execution& execution) {
    const LargeArray<Index> bodies = bodies_of_primitives(execution);
    const std::vector<unsigned char> at_rest = surface_.fixed_bodies();
    tree_.emplace(order_at(start, {bodies, at_rest}, execution), count_, bodies, CornerRows{rows_, size}, execution);
    spread_ = spread(start);
  }

  LargeArray<Index> order_at(const PositionsView& start, const PrimitiveGroups& bodies, const Execution& execution) {
    if constexpr (size == 1) {
      NumberedPoints points = points_at(start, execution);
      if (!tree_) curve_.points = points;
      sort_along_curve(points);
      if (!tree_) curve_.places = places_of(points);
      return block_order_along(std::move(points), bodies, Bvh::width, execution);
    } else {
      // A tree that is built again sorts its own primitives: the vertices' tree may be an old one.
      if (!vertices_ || tree_)
        return block_order(centres_of(all(), points_at(start, execution), execution), bodies, Bvh::width, execution);
      const auto& [points, places] = vertices_->curve();
      const auto [resting, others] = divide_order(order_by_corners(rows_, count_, size, places), bodies, Bvh::width);
      LargeArray<Index> blocks =
          block_order_along(centres_of(others, points, execution), bodies, Bvh::width, execution);
      blocks.insert(blocks.end(), resting.begin(), resting.end());
      return blocks;
    }
  }

  /// Of all vertices, scaled so that no sum overflows; zero for vertices beyond single precision.
  NumberedPoints points_at(const PositionsView& start, const Execution& execution) const {
    NumberedPoints points(static_cast<std::size_t>(surface_.vertex_count()));
    execution.for_chunks(surface_.vertex_count(), chunk_size, [&](Index begin, Index end, Index) {
      for (Index vertex = begin; vertex < end; ++vertex) {
        const Eigen::Vector3f point = (start.row(vertex) - start.row(0)).template cast<float>() / 4;
        const bool is_finite = point.allFinite();
        points[vertex] = {{is_finite ? point[0] : 0, is_finite ? point[1] : 0, is_finite ? point[2] : 0}, vertex};
      }
    });
    return points;
  }

  static LargeArray<Index> places_of(const NumberedPoints& along_curve) {
    LargeArray<Index> places(along_curve.size());
    for (std::size_t place = 0; place < along_curve.size(); ++place)
      places[along_curve[place].number] = static_cast<Index>(place);
    return places;
  }

  LargeArray<Index> all() const {
    LargeArray<Index> all(at(count_));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  /// Sums of the corners of some primitives.
  NumberedPoints centres_of(std::span<const Index> primitives, const NumberedPoints& points,
                            const Execution& execution) const {
    NumberedPoints centres(primitives.size());
    execution.for_chunks(static_cast<Index>(primitives.size()), chunk_size, [&](Index begin, Index end, Index) {
      for (Index place = begin; place < end; ++place) {
        const Index primitive = primitives[at(place)];
        const auto corners = row(primitive);
        NumberedPoint centre = points[corners[0]];
        for (std::size_t k = 1; k < static_cast<std::size_t>(size); ++k)
          for (std::size_t axis = 0; axis < 3; ++axis) centre.position[axis] += points[corners[k]].position[axis];
        centre.number = primitive;
        centres[place] = centre;
      }
    });
    return centres;
  }

  /// Empty if there is only one body.
  LargeArray<Index> bodies_of_primitives(const Execution& execution) const {
    if (surface_.bodies().size() == 1) return {};
    LargeArray<Index> bodies(at(count_));
    execution.for_chunks(count_, chunk_size, [&](Index begin, Index end, Index) {
      for (Index primitive = begin; primitive < end; ++primitive)
        bodies[primitive] = surface_.body_of(row(primitive)[0]);
    });
    return bodies;
  }

  /// Mean extent of a sample of blocks, relative to the whole extent. It is constant while neighbors stay together.
  double spread(const PositionsView& start) const {
    constexpr std::size_t stride = 8;
    const LargeArray<Index>& order = tree_->order();
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

  const Surface& surface_;
  const Index* rows_;
  Index count_;
  const PrimitiveTree<1>* vertices_;
  Curve curve_;
  std::optional<Bvh> tree_;
  bool has_boxes_ = false;
  double spread_ = 0;  // when the tree was built
};

}  // namespace stiv
