// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "acceptance/closed_body.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// What two closed bodies have in common.
struct CommonVolume {
  double volume = 0;
  double area = 0;  ///< of either surface inside of the other: what the volume changes by for each unit they move
};

/// The volumes that pairs of closed bodies have in common, found from their surfaces: with winding numbers w, by the
/// divergence theorem, 3 V = integral of w_b x.n over the surface of a + integral of w_a x.n over that of b.
/// (mathematics.md, "Excluded pairs")
class CommonVolumes {
 public:
  /// @param pairs triangles that may intersect; of these bodies the closed ones are looked at, two by two
  CommonVolumes(std::shared_ptr<const Surface> surface, const IndexPairs& pairs);

  bool empty() const { return bodies_.empty(); }

  /// For each pair of bodies at positions q, (N, 3); nothing where two triangles are not in general position.
  /// @param intersecting all pairs of triangles that intersect there, sorted
  std::vector<std::optional<CommonVolume>> at(const Positions& q, const IndexPairs& intersecting) const;

 private:
  std::shared_ptr<const Surface> surface_;
  std::vector<std::array<Index, 2>> bodies_;  ///< pairs, sorted, smaller one first
  std::map<Index, ClosedBody> closed_;
};

}  // namespace stiv
