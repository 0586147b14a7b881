// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "penetration/body_penetrations.hpp"

namespace stiv {

/// Marks the bodies with a vertex that differs in any bit between two positions, (N, 3) each.
std::vector<unsigned char> displaced_bodies(const Surface& surface, const Positions& from, const Positions& to);

/// Detects whether bodies with excluded pairs penetrate deeper than at the start of the session (BodyPenetrations).
/// Comparing with the start, not with the last state, allows bodies to return, and rounding does not accumulate.
/// (mathematics.md, "Excluded pairs")
class DepthWatch {
 public:
  /// @param excluded pairs of triangles that may intersect
  /// @param rounding largest displacement of a vertex by storage
  DepthWatch(std::shared_ptr<const Surface> surface, IndexPairs excluded, double rounding)
      : surface_(std::move(surface)), excluded_(std::move(excluded)), rounding_(rounding) {}

  bool begun() const { return penetrations_.has_value(); }

  /// Measures the start.
  /// @param intersecting all pairs of triangles that intersect at q, sorted
  void begin(const Positions& q, const IndexPairs& intersecting);

  /// True if any pair of bodies penetrates deeper than at the start, beyond rounding. Only pairs with a body displaced
  /// since the last call are measured again.
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
