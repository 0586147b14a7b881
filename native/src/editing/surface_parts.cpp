// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/surface_parts.hpp"

#include <algorithm>
#include <array>

#include "penetration/body_components.hpp"

namespace stiv {

namespace {

/// Flags the triangles of all triangulations of a polygon but the first: a polygon of n vertices has n - 2 triangles.
std::vector<unsigned char> extra_triangles(const Surface& surface) {
  if (!surface.has_flip_faces()) return {};
  const std::vector<std::vector<Index>>& polygons = surface.definition().flip_faces;
  std::vector<std::vector<std::size_t>> around(at(surface.vertex_count()));
  std::vector<std::size_t> left;
  for (std::size_t polygon = 0; polygon < polygons.size(); ++polygon) {
    for (const Index vertex : polygons[polygon]) around[at(vertex)].push_back(polygon);
    left.push_back(std::max<std::size_t>(polygons[polygon].size(), 2) - 2);
  }
  const Triangles& triangles = surface.triangles();
  std::vector<unsigned char> extra(static_cast<std::size_t>(triangles.rows()), 0);
  for (Index triangle = 0; triangle < static_cast<Index>(triangles.rows()); ++triangle) {
    const std::array<Index, 3> corners{triangles(triangle, 0), triangles(triangle, 1), triangles(triangle, 2)};
    if (!surface.in_one_flip_face(corners)) continue;
    const auto is_around = [&](Index vertex, std::size_t polygon) {
      return std::find(around[at(vertex)].begin(), around[at(vertex)].end(), polygon) != around[at(vertex)].end();
    };
    for (const std::size_t polygon : around[at(corners[0])])
      if (is_around(corners[1], polygon) && is_around(corners[2], polygon)) {
        extra[at(triangle)] = left[polygon] == 0;
        left[polygon] -= left[polygon] > 0;
        break;
      }
  }
  return extra;
}

}  // namespace

SurfaceParts::SurfaceParts(const Surface& surface)
    : surface_(surface), component_(surface.connected_components()), extra_(extra_triangles(surface)) {
  std::vector<std::array<Index, 3>> triangles;
  for (Index triangle = 0; triangle < static_cast<Index>(surface.triangles().rows()); ++triangle)
    if (is_first(triangle)) {
      const auto& corners = surface.triangles().row(triangle);
      triangles.push_back({corners[0], corners[1], corners[2]});
    }
  closed_.assign(component_.size(), 1);  // by the first vertex of each component, then by vertex
  for (const auto& edge : boundary_edges(triangles)) closed_[at(component_[at(edge[0])])] = 0;
  for (std::size_t vertex = 0; vertex < closed_.size(); ++vertex) closed_[vertex] = closed_[at(component_[vertex])];
}

}  // namespace stiv
