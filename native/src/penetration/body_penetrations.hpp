// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "penetration/penetration.hpp"
#include "stiv/surface.hpp"

namespace stiv {

using BodyPairs = std::vector<std::pair<Index, Index>>;

/// The penetration of pairs of bodies: the common volume of two closed bodies, or the area of an open body inside a
/// closed one. Pairs of open bodies and a body with itself are left out. The closed and the open connected components
/// of a body count as two.
class BodyPenetrations {
 public:
  /// The bodies of two components, and whether they are closed.
  struct Pair {
    std::array<Index, 2> bodies{};
    std::array<bool, 2> closed{};
    bool operator==(const Pair&) const = default;
  };

  /// @param excluded pairs of triangles that may intersect; their components are measured
  /// @param start (N, 3) positions that define areas, and the orientation of closed components
  /// @param rounding largest displacement of a vertex by rounding
  BodyPenetrations(std::shared_ptr<const Surface> surface, const IndexPairs& excluded, const Positions& start,
                   double rounding);

  /// The same for all components of pairs of bodies that meet. Two open components are measured too, by the length of
  /// the curve in which they intersect.
  static BodyPenetrations of_bodies(std::shared_ptr<const Surface> surface, const BodyPairs& bodies,
                                    const Positions& start, double rounding);

  /// The measured pairs, in a fixed order.
  std::vector<Pair> pairs() const;

  /// Updates the penetrations of pairs with a body marked in `displaced` to positions q, (N, 3).
  /// @param intersecting all pairs of triangles that intersect at q
  void update(std::vector<Penetration>& penetrations, const std::vector<unsigned char>& displaced, const Positions& q,
              const IndexPairs& intersecting) const;

 private:
  BodyPenetrations(std::shared_ptr<const Surface> surface, double rounding);

  struct Component {
    Index body = 0;
    bool closed = false;
    BodyMesh mesh;
    std::vector<double> start_areas;
    double facing = 1;  ///< 1 outward, -1 inward
  };
  /// The component of a triangle of the surface, and its index there.
  struct Place {
    Index component = -1, triangle = 0;
  };

  void add_components(Index body, const Positions& start);
  void add_component(Index body, bool closed, std::vector<Index> triangles, const Positions& start);
  const Component& component(Index number) const { return components_[at(number)]; }
  const Place& place(Index triangle) const { return places_[at(triangle)]; }
  std::array<Index, 2> ordered(Index a, Index b) const;
  bool is_measurable(const std::array<Index, 2>& components) const;
  std::vector<IndexPairs> pairs_of_components(const IndexPairs& intersecting) const;
  Penetration measured(const std::array<Index, 2>& components, const IndexPairs& candidates, const Positions& q) const;

  std::shared_ptr<const Surface> surface_;
  double rounding_;
  std::vector<Component> components_;
  std::vector<Place> places_;                ///< by the triangles of the surface
  std::vector<std::array<Index, 2>> pairs_;  ///< of components, sorted and unique; an open one comes first
};

}  // namespace stiv
