// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/body_components.hpp"

#include <algorithm>
#include <iterator>

#include "penetration/body_mesh.hpp"

namespace stiv {

namespace {

std::vector<Index> triangles_of(const Surface& surface, Index body) {
  std::vector<Index> triangles;
  for (Index triangle = 0; triangle < static_cast<Index>(surface.triangles().rows()); ++triangle)
    if (surface.body_of(surface.triangles()(triangle, 0)) == body) triangles.push_back(triangle);
  return triangles;
}

/// The seed of the component of each vertex.
std::vector<Index> seeds_of_vertices(const BodyMesh& mesh) {
  std::vector<Index> seed(mesh.vertices.size());
  for (const Index vertex : mesh.seeds) seed[at(vertex)] = vertex;
  for (const auto& [from, to] : mesh.walk) seed[at(to)] = seed[at(from)];
  return seed;
}

}  // namespace

std::vector<std::array<Index, 2>> boundary_edges(const std::vector<std::array<Index, 3>>& triangles) {
  std::vector<std::array<Index, 2>> upward, downward, boundary;
  for (const auto& corners : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = corners[k], to = corners[(k + 1) % 3];
      if (from < to) upward.push_back({from, to});
      if (to < from) downward.push_back({to, from});
    }
  std::sort(upward.begin(), upward.end());
  std::sort(downward.begin(), downward.end());
  std::set_symmetric_difference(upward.begin(), upward.end(), downward.begin(), downward.end(),
                                std::back_inserter(boundary));
  return boundary;
}

BodyComponents body_components(const Surface& surface, Index body) {
  const BodyMesh mesh = body_mesh(surface, triangles_of(surface, body));
  const std::vector<Index> seed = seeds_of_vertices(mesh);
  std::vector<unsigned char> has_boundary(mesh.vertices.size(), 0);  // by seed
  for (const auto& edge : boundary_edges(mesh.corners)) has_boundary[at(seed[at(edge[0])])] = 1;
  BodyComponents components;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    (has_boundary[at(seed[at(mesh.corners[k][0])])] != 0 ? components.open : components.closed)
        .push_back(mesh.triangles[k]);
  return components;
}

}  // namespace stiv
