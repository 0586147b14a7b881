// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "penetration/body_penetrations.hpp"

namespace stiv {

/// Keeps bodies of which pairs are excluded from going deeper into each other than they were at the start of the
/// session: two closed ones by the volume that they have in common, an open and a closed one by the area of the first
/// inside of the second. Compared with the start and not with the state before, so that what went out may come back as
/// far, and rounding does not add up. (mathematics.md, "Excluded pairs")
class DepthWatch {
 public:
  /// @param excluded pairs of triangles that may intersect
  /// @param rounding how far storing may move a vertex
  DepthWatch(std::shared_ptr<const Surface> surface, IndexPairs excluded, double rounding)
      : surface_(std::move(surface)), excluded_(std::move(excluded)), rounding_(rounding) {}

  bool begun() const { return penetrations_.has_value(); }

  /// Measures the start.
  /// @param intersecting all pairs of triangles that intersect at q, sorted
  void begin(const Positions& q, const IndexPairs& intersecting);

  /// Is any pair of bodies deeper in each other than at the start, beyond rounding? Only those that were displaced
  /// since the last time it was asked are measured again.
  bool is_deeper(const Positions& q, const IndexPairs& intersecting);

 private:
  std::shared_ptr<const Surface> surface_;
  IndexPairs excluded_;
  double rounding_;
  std::optional<BodyPenetrations> penetrations_;
  std::vector<Penetration> at_start_, last_;
  Positions last_positions_;
};

}  // namespace stiv
