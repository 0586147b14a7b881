// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "penetration/penetration.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// How deep bodies are in each other: of two closed ones the volume that they have in common, of an open one the area
/// inside of a closed one. Two open ones have no inside, and a body with itself is not looked at. A body of which some
/// connected components are closed and others are not is taken as two.
class BodyPenetrations {
 public:
  /// Of two parts: indices of their bodies, and are they closed?
  struct Pair {
    std::array<Index, 2> bodies{};
    std::array<bool, 2> closed{};
    bool operator==(const Pair&) const = default;
  };

  /// @param excluded pairs of triangles that may intersect: they tell which parts are looked at
  /// @param start (N, 3): areas there count, and so does the side to which a closed part faces
  /// @param rounding how far a vertex may be moved without anybody's doing
  BodyPenetrations(std::shared_ptr<const Surface> surface, const IndexPairs& excluded, const Positions& start,
                   double rounding);

  /// What is looked at, in a fixed order.
  std::vector<Pair> pairs() const;

  /// Measures at positions q, (N, 3), the pairs with a body that is marked in `displaced`; the others in `penetrations`
  /// stay as they are.
  /// @param intersecting all pairs of triangles that intersect there
  void update(std::vector<Penetration>& penetrations, const std::vector<unsigned char>& displaced, const Positions& q,
              const IndexPairs& intersecting) const;

 private:
  struct Part {
    Index body = 0;
    bool closed = false;
    BodyMesh mesh;
    std::vector<double> start_areas;
    double facing = 1;  ///< 1 outward, -1 inward
  };
  /// Where a triangle of the surface is found.
  struct Place {
    Index part = -1, triangle = 0;
  };

  void add_parts(Index body, const Positions& start);
  void add_part(Index body, bool closed, std::vector<Index> triangles, const Positions& start);
  const Part& part(Index number) const { return parts_[at(number)]; }
  const Place& place(Index triangle) const { return places_[at(triangle)]; }
  std::array<Index, 2> ordered(Index a, Index b) const;
  bool is_measurable(const std::array<Index, 2>& parts) const;
  std::vector<IndexPairs> meeting_by_pair(const IndexPairs& intersecting) const;
  Penetration measured(const std::array<Index, 2>& parts, const IndexPairs& meeting, const Positions& q) const;

  std::shared_ptr<const Surface> surface_;
  double rounding_;
  std::vector<Part> parts_;
  std::vector<Place> places_;                ///< by the triangles of the surface
  std::vector<std::array<Index, 2>> pairs_;  ///< of parts, each once, sorted; where one is open, it comes first
};

}  // namespace stiv
