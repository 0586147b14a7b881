// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "detection/broad_phase/vertex_steps.hpp"
#include "stiv/detection/event.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Up to `capacity` pairs, each of four vertices in the order of Event::vertices, as arrays over the pairs.
struct PairBlock {
  static constexpr std::size_t capacity = 64;

  std::array<std::array<Index, capacity>, 4> vertices{};
  std::size_t count = 0;

  void add(const std::array<Index, 4>& pair) {
    for (std::size_t k = 0; k < 4; ++k) vertices[k][count] = pair[k];
    ++count;
  }
  std::array<Index, 4> vertices_of(std::size_t k) const {
    return {vertices[0][k], vertices[1][k], vertices[2][k], vertices[3][k]};
  }
};

/// The vertices of up to PairBlock::capacity pairs, wherever they are. Vector code reads a vector's width from the last
/// pair on: there must be numbers of vertices.
struct PairView {
  PairView(const PairBlock& block) : count(block.count) {
    for (std::size_t k = 0; k < 4; ++k) vertices[k] = block.vertices[k].data();
  }
  PairView(const std::array<const Index*, 4>& of_pairs, std::size_t pair_count)
      : vertices(of_pairs), count(pair_count) {}

  std::array<const Index*, 4> vertices;
  std::size_t count;
};

/// 1 or 0 for each pair of a block.
using PairFlags = std::array<unsigned char, PairBlock::capacity>;

// Each filter flags the pairs that it proves further apart than `separation` for the whole step.

/// By the planes across the axes. Ignores rounding.
void find_apart_by_boxes(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                         PairFlags& apart);

/// By fixed planes, beyond all rounding: fast, and decides most pairs.
void find_apart_by_planes(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices, double separation,
                          PairFlags& apart);

/// By the plane across the closest points of the start, beyond all rounding, if one of these lies on the boundary of
/// its primitive; `find_apart_by_planes` decides the others. Slower, but leaves few close pairs without contact.
void find_apart_by_closest_points(EventKind kind, const PairBlock& pairs, const VertexSteps& vertices,
                                  double separation, PairFlags& apart);

/// Bounds of other steps from the same start: the end of each vertex lies within `slack` times its own displacement
/// (the largest component, less `motion`) of the segment from its start to its end, less `motion`.
struct NearbySteps {
  Vector3 motion = Vector3::Zero();
  double separation = 0;
  double slack = 0;
  double rounding = 0x1p-43;  ///< bound of the rounding error, relative to the coordinates
};

/// By directions of the start (the normal, between the centers, across an edge) in which the hulls of both sides stay
/// apart in all nearby steps, beyond all rounding. [mathematics.md, "Rounds of one edit"]
void find_apart_by_hulls(EventKind kind, const PairView& pairs, const VertexSteps& vertices, const NearbySteps& steps,
                         PairFlags& apart);

}  // namespace stiv
