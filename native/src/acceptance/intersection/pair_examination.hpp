// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "acceptance/intersection/primitives.hpp"
#include "acceptance/intersection/separating_plane_filter.hpp"

namespace stiv {

/// Decides pair by pair what intersects, and reports it. Neighbours are tested one by one; all others wait for a filter
/// of many at once.
class PairExamination {
 public:
  /// Returns whether to go on.
  using Report = std::function<bool(const PrimitivePair&)>;

  /// @param points the same as `q`
  PairExamination(const Surface& surface, const Primitives& first, const Primitives& second, const PositionsView& q,
                  const PointRows& points, Report report);

  /// Takes a candidate. False: no more are wanted.
  bool take(const PrimitivePair& pair);

  /// Decides what still waits.
  bool finish();

 private:
  bool meet(const PrimitivePair& pair) const;

  const Surface& surface_;
  const Primitives &first_, &second_;
  PositionsView q_;
  const PointRows& points_;
  Report report_;
  TrianglePairs waiting_;
  std::array<PrimitivePair, TrianglePairs::capacity> pairs_;
};

}  // namespace stiv
