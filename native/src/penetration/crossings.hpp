// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "penetration/body_mesh.hpp"
#include "stiv/acceptance/intersections.hpp"

namespace stiv {

/// The intersection of an edge of one body with a triangle of the other.
struct EdgeCrossing {
  std::array<Index, 2> edge{};  ///< smaller vertex first
  Index triangle = 0;
  int step = 0;   ///< from the first vertex: 1 from the triangle's front to its back, else -1
  double at = 0;  ///< fraction of the edge
};

/// The intersection segment of two triangles, from end 0 to end 1 in the direction of the cross product of their
/// normals.
struct Cut {
  std::array<Index, 2> triangles{};  ///< of the first and the second body
  std::array<std::array<Eigen::Vector2d, 2>, 2>
      ends{};  ///< for each triangle, the ends as weights of its second and third corner
};

/// The crossings of two bodies' surfaces. Which edges and triangles cross, and in which direction, is exact. Positions
/// on edges and triangles are rounded. Refers to the bodies.
class Crossings {
 public:
  /// @param candidates pairs (triangle of the first body, of the second), all intersecting ones included
  /// @param perturbation of the second body, see PerturbedSign
  Crossings(const PlacedBody& first, const PlacedBody& second, const IndexPairs& candidates, int perturbation);

  const PlacedBody& body(std::size_t side) const { return *bodies_[side]; }
  /// The perturbation of a side's body relative to the other.
  int perturbation(std::size_t side) const { return side == 1 ? perturbation_ : -perturbation_; }
  /// True if the perturbation decided a crossing.
  bool touching() const { return touching_; }
  const std::vector<Cut>& cuts() const { return cuts_; }

  /// The increase of the winding number w of the other body along an edge of a side's body.
  int winding_increase(std::size_t side, Index from, Index to) const;

  /// The mean of w along an edge, given w at its first vertex.
  double mean_along(std::size_t side, Index from, Index to, int at_beginning) const;

 private:
  void add(const std::array<Index, 2>& triangles);
  template <class Visit>
  void along(std::size_t side, Index a, Index b, const Visit& visit) const;

  std::array<const PlacedBody*, 2> bodies_;
  int perturbation_;
  bool touching_ = false;
  std::array<std::vector<EdgeCrossing>, 2> crossings_;  ///< by the edges of each side, sorted, each once
  std::vector<Cut> cuts_;
};

}  // namespace stiv
