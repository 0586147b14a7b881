// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "acceptance/intersection/packed_points.hpp"
#include "detection/broad_phase/bounds.hpp"
#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Positions of all vertices and their boxes, kept from test to test: large bodies at rest cost only a comparison.
class PlacedVertices {
 public:
  /// @param resting as in IntersectionTestOptions
  explicit PlacedVertices(const Surface& surface, Index resting = 0) : surface_(&surface), resting_(resting) {}

  /// @param moved as in IntersectionTest::is_free
  /// @param margin of the boxes on each side
  void update(const PositionsView& q, const std::vector<unsigned char>& moved, double margin,
              const Execution& execution);

  const PackedPoints& points() const { return points_; }
  /// A box is active if its vertex is marked in `moved`, and not one of those that rest.
  const LargeArray<PackedBox>& boxes() const { return boxes_; }
  /// 1 for each body with a vertex that the last update changed.
  const std::vector<unsigned char>& changed_bodies() const { return changed_bodies_; }
  /// Does the vertex belong to one of them?
  bool is_in_changed_body(Index vertex) const { return changed_bodies_[at(surface_->body_of(vertex))] != 0; }

 private:
  void place(const PositionsView& q, Index vertex, bool active);
  bool is_placed(const PositionsView& q, Index vertex, bool active) const;

  const Surface* surface_;
  Index resting_;
  PackedPoints points_;
  LargeArray<PackedBox> boxes_;
  double margin_ = 0;  // of the boxes
  std::vector<unsigned char> changed_bodies_;
};

}  // namespace stiv
