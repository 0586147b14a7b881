// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>

#include "input.hpp"
#include "stiv/surface.hpp"

namespace stiv::fuzz {

using Corners = std::array<Index, 3>;

/// The vertices of a triangle.
inline Corners corners(const Surface& surface, Index face) {
  const auto row = surface.triangles().row(face);
  return {row[0], row[1], row[2]};
}

/// A few vertices, triangles with randomly repeated or shared corners, and a few loose edges.
inline std::shared_ptr<const Surface> small_surface(Input& input) {
  SurfaceDefinition definition;
  definition.vertex_count = 3 + input.below(14);
  definition.triangles.resize(1 + input.below(14), 3);
  // Fans around a vertex, as in meshes, or any three vertices.
  const bool fans = input.below(2) == 0;
  for (Index face = 0; face < definition.triangles.rows(); ++face) {
    for (Index k = 0; k < 3; ++k) definition.triangles(face, k) = input.below(definition.vertex_count);
    if (fans && face > 0) {
      definition.triangles(face, 0) = definition.triangles(face - 1, 0);
      definition.triangles(face, 1) = definition.triangles(face - 1, 2);
    }
  }
  definition.loose_edges.resize(input.below(3), 2);
  for (Index edge = 0; edge < definition.loose_edges.rows(); ++edge)
    for (Index k = 0; k < 2; ++k) definition.loose_edges(edge, k) = input.below(definition.vertex_count);
  return std::make_shared<const Surface>(definition);
}

}  // namespace stiv::fuzz
