// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/components.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace stiv {

namespace {

void append_triangle(const Surface& surface, Index triangle, std::vector<Index>& vertices) {
  for (const Index vertex : surface.triangles().row(triangle)) vertices.push_back(vertex);
}

/// For each body, 1 if every edge of its triangles is an edge of exactly two.
std::vector<unsigned char> closed_bodies(const Surface& surface) {
  std::vector<std::pair<Index, Index>> sides;
  for (const auto& corners : surface.triangles().rowwise())
    for (Index k = 0; k < 3; ++k) sides.push_back(std::minmax({corners[k], corners[(k + 1) % 3]}));
  std::sort(sides.begin(), sides.end());
  std::vector<unsigned char> closed(surface.bodies().size(), 1);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last] == sides[first]) ++last;
    if (last - first != 2) closed[at(surface.body_of(sides[first].first))] = 0;
  }
  return closed;
}

std::vector<Index> bodies_of(const Surface& surface, const std::vector<Index>& vertices) {
  std::vector<Index> bodies;
  for (const Index vertex : vertices) bodies.push_back(surface.body_of(vertex));
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

/// For each body, the number of pairs with a vertex of it.
std::vector<std::size_t> pairs_of_bodies(const Surface& surface, const std::vector<std::vector<Index>>& pairs) {
  std::vector<std::size_t> count(surface.bodies().size(), 0);
  for (const std::vector<Index>& pair : pairs)
    for (const Index body : bodies_of(surface, pair)) ++count[at(body)];
  return count;
}

/// The connected component of `seed`, breadth first; marks it in `reached`.
std::vector<Index> connected_to(const Surface& surface, Index seed, Marks& reached) {
  std::vector<Index> component{seed};
  reached[at(seed)] = 1;
  for (std::size_t k = 0; k < component.size(); ++k)
    for (const Index* n = surface.neighbours_begin(component[k]); n != surface.neighbours_end(component[k]); ++n)
      if (reached[at(*n)] == 0) {
        reached[at(*n)] = 1;
        component.push_back(*n);
      }
  return component;
}

Marks marks_of(const std::vector<Index>& vertices, const Marks& among) {
  Marks marks(among.size(), 0);
  for (const Index vertex : vertices) marks[at(vertex)] = among[at(vertex)];
  return marks;
}

}  // namespace

std::vector<std::vector<Index>> vertices_of_pairs(const Surface& surface, const StaticPairs& pairs) {
  std::vector<std::vector<Index>> result;
  for (const auto& [first, second] : pairs.faces) {
    append_triangle(surface, first, result.emplace_back());
    append_triangle(surface, second, result.back());
  }
  for (const auto& [edge, triangle] : pairs.loose_edges) {
    result.push_back({surface.loose_edges()(edge, 0), surface.loose_edges()(edge, 1)});
    append_triangle(surface, triangle, result.back());
  }
  for (const auto& [vertex, triangle] : pairs.loose_vertices) {
    result.push_back({vertex});
    append_triangle(surface, triangle, result.back());
  }
  return result;
}

std::vector<Index> bodies_in_pairs(const Surface& surface, const std::vector<std::vector<Index>>& pairs) {
  const std::vector<std::size_t> count = pairs_of_bodies(surface, pairs);
  std::vector<Index> bodies;
  for (Index body = 0; body < static_cast<Index>(count.size()); ++body)
    if (count[at(body)] > 0) bodies.push_back(body);
  return bodies;
}

std::vector<Index> bodies_in_all_pairs(const Surface& surface, const std::vector<std::vector<Index>>& pairs) {
  const std::vector<std::size_t> count = pairs_of_bodies(surface, pairs);
  const std::vector<unsigned char> closed = closed_bodies(surface);
  std::vector<Index> bodies;
  for (Index body = 0; body < static_cast<Index>(count.size()); ++body)
    if (count[at(body)] == pairs.size()) bodies.push_back(body);
  std::stable_partition(bodies.begin(), bodies.end(), [&](Index body) { return closed[at(body)] != 0; });
  return bodies;
}

Marks marks_of_bodies(const Surface& surface, const std::vector<Index>& bodies, const Marks& among) {
  Marks marks(among.size(), 0);
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (std::binary_search(bodies.begin(), bodies.end(), surface.body_of(vertex)))
      marks[at(vertex)] = among[at(vertex)];
  return marks;
}

std::vector<Marks> components_in_pairs(const Surface& surface, const std::vector<std::vector<Index>>& pairs,
                                       const Marks& among) {
  Marks reached(among.size(), 0);
  std::vector<std::vector<Index>> components;
  for (const std::vector<Index>& pair : pairs)
    for (const Index vertex : pair)
      if (reached[at(vertex)] == 0) components.push_back(connected_to(surface, vertex, reached));
  std::stable_sort(components.begin(), components.end(),
                   [](const auto& a, const auto& b) { return a.size() < b.size(); });
  std::vector<Marks> marks;
  for (const std::vector<Index>& component : components) marks.push_back(marks_of(component, among));
  return marks;
}

Marks region_around(const Surface& surface, const std::vector<std::vector<Index>>& pairs, int rings,
                    const Marks& among) {
  Marks reached(among.size(), 0);
  std::vector<Index> region;
  const auto reach = [&](Index vertex) {
    if (reached[at(vertex)] != 0) return;
    reached[at(vertex)] = 1;
    region.push_back(vertex);
  };
  for (const std::vector<Index>& pair : pairs)
    for (const Index vertex : pair) reach(vertex);
  std::size_t begin = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t end = region.size();
    for (; begin < end; ++begin) {
      const Index vertex = region[begin];
      for (const Index* n = surface.neighbours_begin(vertex); n != surface.neighbours_end(vertex); ++n) reach(*n);
    }
  }
  return marks_of(region, among);
}

}  // namespace stiv
