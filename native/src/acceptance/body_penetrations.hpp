// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "acceptance/penetration.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// How deep bodies are in each other: of two closed ones the volume that they have in common, of an open one the area
/// inside of a closed one. Two open bodies have no inside, and a body with itself is not looked at.
class BodyPenetrations {
 public:
  /// @param pairs triangles that may intersect; of these bodies pairs are made
  /// @param start (N, 3): areas there count, and so does the side to which a closed body faces
  /// @param rounding how far a vertex may be moved without anybody's doing
  BodyPenetrations(std::shared_ptr<const Surface> surface, const IndexPairs& pairs, const Positions& start,
                   double rounding);

  /// The pairs of bodies that are looked at, sorted, smaller one first.
  const std::vector<std::array<Index, 2>>& pairs() const { return pairs_; }

  /// Measures at positions q, (N, 3), the pairs with a body that is marked in `displaced`; the others in `penetrations`
  /// stay as they are.
  /// @param intersecting all pairs of triangles that intersect there, smaller one first
  void update(std::vector<Penetration>& penetrations, const std::vector<unsigned char>& displaced, const Positions& q,
              const IndexPairs& intersecting) const;

 private:
  struct Watched {
    BodyMesh mesh;
    std::vector<double> start_areas;
    double facing = 1;  ///< of a closed one: 1 outward, -1 inward
  };

  std::vector<IndexPairs> meeting_by_pair(const IndexPairs& intersecting) const;
  Penetration measured(const std::array<Index, 2>& bodies, IndexPairs meeting, const Positions& q) const;

  std::shared_ptr<const Surface> surface_;
  double rounding_;
  std::vector<std::array<Index, 2>> pairs_;
  std::map<Index, Watched> watched_;
};

}  // namespace stiv
