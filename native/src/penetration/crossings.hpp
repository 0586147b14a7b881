// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "penetration/placed_body.hpp"
#include "stiv/acceptance/intersections.hpp"

namespace stiv {

/// Where an edge of one body goes through a triangle of the other.
struct EdgeCrossing {
  std::array<Index, 2> edge{};  ///< smaller vertex first
  Index triangle = 0;
  int step = 0;   ///< from the first vertex on: 1 from the triangle's front to its back, else -1
  double at = 0;  ///< fraction of the edge
};

/// The segment in which two triangles cross, from its end 0 to its end 1 along the normal of the first times that of
/// the second.
struct Cut {
  std::array<Index, 2> triangles{};                      ///< of the first and the second body
  std::array<std::array<Eigen::Vector2d, 2>, 2> ends{};  ///< for each, ends: weights of its second and third corner
};

/// Where two bodies cross. What crosses what, which way and in which order is exact; where on an edge and in a triangle
/// is rounded. Keeps the bodies by reference.
class Crossings {
 public:
  /// @param meeting pairs of triangles, of the first and of the second body, among which are all that intersect
  /// @param nudge of the second body: see nudged_orientation.hpp
  Crossings(const PlacedBody& first, const PlacedBody& second, const IndexPairs& meeting, int nudge);

  const PlacedBody& body(std::size_t side) const { return *bodies_[side]; }
  /// Of the body of a side, against the other.
  int nudge(std::size_t side) const { return side == 1 ? nudge_ : -nudge_; }
  /// Did the nudge have a say?
  bool touching() const { return touching_; }
  const std::vector<Cut>& cuts() const { return cuts_; }

  /// What w, how often the other body winds around a point, gains along an edge of the body of a side.
  int gained(std::size_t side, Index from, Index to) const;

  /// The mean of w along such an edge, w at whose beginning is given.
  double mean_along(std::size_t side, Index from, Index to, int at_beginning) const;

 private:
  void add(const std::array<Index, 2>& triangles);
  template <class Visit>
  void along(std::size_t side, Index a, Index b, const Visit& visit) const;

  std::array<const PlacedBody*, 2> bodies_;
  int nudge_;
  bool touching_ = false;
  std::array<std::vector<EdgeCrossing>, 2> crossings_;  ///< by the edges of each side, sorted, each once
  std::vector<Cut> cuts_;
};

}  // namespace stiv
