// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/body_mesh.hpp"

#include <algorithm>

namespace stiv {

namespace {

using Edge = std::array<Index, 2>;

std::size_t at(Index k) { return static_cast<std::size_t>(k); }

void sort_and_unify(std::vector<Index>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

void gather_triangles(BodyMesh& mesh, const Surface& surface, Index body) {
  const Triangles& triangles = surface.triangles();
  for (Index triangle = 0; triangle < static_cast<Index>(triangles.rows()); ++triangle) {
    if (surface.body_of(triangles(triangle, 0)) != body) continue;
    mesh.triangles.push_back(triangle);
    for (const Index vertex : triangles.row(triangle)) mesh.vertices.push_back(vertex);
  }
  sort_and_unify(mesh.vertices);
  const auto place = [&](Index vertex) {
    const auto found = std::lower_bound(mesh.vertices.begin(), mesh.vertices.end(), vertex);
    return static_cast<Index>(found - mesh.vertices.begin());
  };
  for (const Index triangle : mesh.triangles) {
    const auto row = triangles.row(triangle);
    mesh.corners.push_back({place(row[0]), place(row[1]), place(row[2])});
  }
}

/// Those that run from a smaller vertex to a larger one, or the other way; smaller vertex first, sorted.
std::vector<Edge> edges_that_run(bool upward, const BodyMesh& mesh) {
  std::vector<Edge> edges;
  for (const auto& corners : mesh.corners)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = corners[k], to = corners[(k + 1) % 3];
      if (upward ? from < to : to < from) edges.push_back({std::min(from, to), std::max(from, to)});
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::vector<std::vector<Index>> neighbours_by(const std::vector<Edge>& edges, std::size_t vertex_count) {
  std::vector<std::vector<Index>> neighbours(vertex_count);
  for (const auto& [a, b] : edges) {
    neighbours[at(a)].push_back(b);
    neighbours[at(b)].push_back(a);
  }
  return neighbours;
}

/// A walk over all vertices, component by component.
void walk_over(BodyMesh& mesh, const std::vector<std::vector<Index>>& neighbours) {
  std::vector<unsigned char> reached(neighbours.size(), 0);
  std::vector<Index> waiting;
  for (Index seed = 0; seed < static_cast<Index>(neighbours.size()); ++seed) {
    if (reached[at(seed)] != 0) continue;
    reached[at(seed)] = 1;
    mesh.seeds.push_back(seed);
    waiting.assign(1, seed);
    while (!waiting.empty()) {
      const Index from = waiting.back();
      waiting.pop_back();
      for (const Index to : neighbours[at(from)]) {
        if (reached[at(to)] != 0) continue;
        reached[at(to)] = 1;
        mesh.walk.push_back({from, to});
        waiting.push_back(to);
      }
    }
  }
}

}  // namespace

BodyMesh body_mesh(const Surface& surface, Index body) {
  BodyMesh mesh;
  gather_triangles(mesh, surface, body);
  std::vector<Edge> edges = edges_that_run(true, mesh);
  const std::vector<Edge> downward = edges_that_run(false, mesh);
  mesh.closed = !edges.empty() && edges == downward;
  edges.insert(edges.end(), downward.begin(), downward.end());
  walk_over(mesh, neighbours_by(edges, mesh.vertices.size()));
  return mesh;
}

}  // namespace stiv
