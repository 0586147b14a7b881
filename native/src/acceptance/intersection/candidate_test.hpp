// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "acceptance/intersection/near_pairs.hpp"
#include "acceptance/intersection/separating_plane_filter.hpp"
#include "detection/primitive_pair.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Do two primitives intersect? Never if they are triangulations of one face.
bool intersect(const Surface& surface, const CornerPair& corners, const PositionsView& q);

/// Tests candidate pairs of primitives and reports those that intersect. Neighbors are tested one by one, other pairs
/// in blocks that pass a filter first.
class CandidateTest {
 public:
  /// Returns false to stop.
  using Report = std::function<bool(const PrimitivePair&)>;

  /// @param points q, packed
  /// @param near lists the candidates that no plane separates by its reach; null: none
  CandidateTest(const Surface& surface, const PositionsView& q, const PackedPoints& points, NearPairs* near,
                Report report);

  /// Adds a candidate. Returns false if the report stopped.
  /// @param pair its numbers, for the report
  bool add(const PrimitivePair& pair, const std::array<Index, 3>& first, const std::array<Index, 3>& second) {
    if (share_corner(first, second)) return test_neighbours(pair, {first, second});
    pairs_[block_.count] = pair;
    block_.add(first, second);
    return block_.count < TrianglePairs::capacity || finish();
  }

  /// Tests the pairs of an incomplete block. Returns false if the report stopped.
  bool finish();

 private:
  bool test_neighbours(const PrimitivePair& pair, const CornerPair& corners);
  void list(const CornerPair& corners);

  const Surface& surface_;
  PositionsView q_;
  const PackedPoints& points_;
  NearPairs* near_;
  Report report_;
  TrianglePairs block_;
  std::array<PrimitivePair, TrianglePairs::capacity> pairs_;
};

}  // namespace stiv
