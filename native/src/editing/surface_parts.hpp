// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "stiv/surface.hpp"

namespace stiv {

/// The connected components of a surface, each named by its first vertex.
class SurfaceParts {
 public:
  explicit SurfaceParts(const Surface& surface);

  Index of(Index triangle) const { return component_[at(first_corner(triangle))]; }

  /// The components of two triangles, smaller number first.
  std::pair<Index, Index> of(const std::pair<Index, Index>& pair) const {
    return std::minmax({of(pair.first), of(pair.second)});
  }

  bool are_of_one_body(const std::pair<Index, Index>& pair) const {
    return surface_.body_of(first_corner(pair.first)) == surface_.body_of(first_corner(pair.second));
  }

  /// Whether a triangle belongs to the first triangulation of its polygon. Others lie beside it: without them, each
  /// point of a component is in one triangle.
  bool is_first(Index triangle) const { return extra_.empty() || extra_[at(triangle)] == 0; }

  /// Whether the component of a triangle has no boundary.
  bool is_closed(Index triangle) const { return closed_[at(first_corner(triangle))] != 0; }

  /// How many of the components of two triangles have no boundary.
  int closed_count(const std::pair<Index, Index>& pair) const {
    return int{is_closed(pair.first)} + int{is_closed(pair.second)};
  }

 private:
  Index first_corner(Index triangle) const { return surface_.triangles()(triangle, 0); }

  const Surface& surface_;
  std::vector<Index> component_;       // of each vertex: its first vertex
  std::vector<unsigned char> extra_;   // of each triangle; empty if each polygon has one triangulation
  std::vector<unsigned char> closed_;  // whether that of each vertex has no boundary
};

}  // namespace stiv
