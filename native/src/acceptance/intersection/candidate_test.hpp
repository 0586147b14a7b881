// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "acceptance/intersection/near_pairs.hpp"
#include "acceptance/intersection/primitives.hpp"
#include "acceptance/intersection/separating_plane_filter.hpp"

namespace stiv {

/// Tests candidate pairs and reports those that intersect. Neighbors are tested one by one, other pairs in blocks that
/// pass a filter first.
class CandidateTest {
 public:
  /// Returns false to stop.
  using Report = std::function<bool(const PrimitivePair&)>;

  /// @param points q, packed
  /// @param near lists the candidates that no plane separates by its reach; null: none
  CandidateTest(const Surface& surface, const Primitives& first, const Primitives& second, const PositionsView& q,
                const PackedPoints& points, NearPairs* near, Report report);

  /// Adds a candidate. Returns false if the report stopped.
  bool add(const PrimitivePair& pair);

  /// Tests the pairs of an incomplete block. Returns false if the report stopped.
  bool finish();

 private:
  bool intersect(const PrimitivePair& pair) const;
  void list(const PrimitivePair& pair);

  const Surface& surface_;
  const Primitives &first_, &second_;
  PositionsView q_;
  const PackedPoints& points_;
  NearPairs* near_;
  Report report_;
  TrianglePairs block_;
  std::array<PrimitivePair, TrianglePairs::capacity> pairs_;
};

}  // namespace stiv
