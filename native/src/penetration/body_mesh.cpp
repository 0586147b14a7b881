// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/body_mesh.hpp"

#include <algorithm>
#include <utility>

namespace stiv {

namespace {

void sort_and_unify(std::vector<Index>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

void count_vertices(BodyMesh& mesh, const Surface& surface) {
  for (const Index triangle : mesh.triangles)
    for (const Index vertex : surface.triangles().row(triangle)) mesh.vertices.push_back(vertex);
  sort_and_unify(mesh.vertices);
  const auto place = [&](Index vertex) {
    const auto found = std::lower_bound(mesh.vertices.begin(), mesh.vertices.end(), vertex);
    return static_cast<Index>(found - mesh.vertices.begin());
  };
  for (const Index triangle : mesh.triangles) {
    const auto row = surface.triangles().row(triangle);
    mesh.corners.push_back({place(row[0]), place(row[1]), place(row[2])});
  }
}

std::vector<std::vector<Index>> neighbours_in(const BodyMesh& mesh) {
  std::vector<std::vector<Index>> neighbours(mesh.vertices.size());
  for (const auto& corners : mesh.corners)
    for (std::size_t k = 0; k < 3; ++k) {
      neighbours[at(corners[k])].push_back(corners[(k + 1) % 3]);
      neighbours[at(corners[k])].push_back(corners[(k + 2) % 3]);
    }
  for (auto& of_vertex : neighbours) sort_and_unify(of_vertex);
  return neighbours;
}

/// Builds the spanning forest, component by component.
void build_forest(BodyMesh& mesh, const std::vector<std::vector<Index>>& neighbours) {
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

BodyMesh body_mesh(const Surface& surface, std::vector<Index> triangles) {
  BodyMesh mesh;
  mesh.triangles = std::move(triangles);
  count_vertices(mesh, surface);
  build_forest(mesh, neighbours_in(mesh));
  return mesh;
}

PlacedBody::PlacedBody(const BodyMesh& mesh, const PositionsView& q) : mesh_(mesh) {
  for (const Index vertex : mesh.vertices) {
    points_.push_back(q.row(vertex));
    box_.extend(points_.back());
  }
}

Triangle PlacedBody::triangle(Index triangle) const {
  const auto& [a, b, c] = corners(triangle);
  return {point(a), point(b), point(c)};
}

Vector3 PlacedBody::area_vector(Index triangle) const {
  const auto& [a, b, c] = corners(triangle);
  return (point(b) - point(a)).cross(point(c) - point(a));
}

double PlacedBody::signed_volume() const {
  double sum = 0;
  for (Index k = 0; k < triangle_count(); ++k) sum += area_vector(k).dot(point(corners(k)[0]) - point(0));
  return sum / 6;
}

}  // namespace stiv
