// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/closed_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiv {

namespace {

using Edge = std::array<Index, 2>;

/// Every edge once, smaller vertex first and sorted; nothing if one does not run exactly once each way.
std::optional<std::vector<Edge>> paired_edges(const Surface& surface, const std::vector<Index>& triangles) {
  std::vector<Edge> forward, backward;
  for (const Index triangle : triangles)
    for (Index k = 0; k < 3; ++k) {
      const Index from = surface.triangles()(triangle, k), to = surface.triangles()(triangle, (k + 1) % 3);
      if (from == to) return std::nullopt;
      if (from < to)
        forward.push_back({from, to});
      else
        backward.push_back({to, from});
    }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  const bool once = std::adjacent_find(forward.begin(), forward.end()) == forward.end();
  if (!once || forward != backward) return std::nullopt;
  return forward;
}

/// A walk over all vertices of the edges, component by component.
void walk_over(ClosedBody& body, Index vertex_count) {
  std::vector<std::vector<Index>> neighbours(static_cast<std::size_t>(vertex_count));
  for (const auto& [a, b] : body.edges) {
    neighbours[static_cast<std::size_t>(a)].push_back(b);
    neighbours[static_cast<std::size_t>(b)].push_back(a);
  }
  std::vector<unsigned char> reached(neighbours.size(), 0);
  std::vector<Index> waiting;
  for (const Edge& edge : body.edges) {
    if (reached[static_cast<std::size_t>(edge[0])] != 0) continue;
    body.seeds.push_back(edge[0]);
    reached[static_cast<std::size_t>(edge[0])] = 1;
    waiting.assign(1, edge[0]);
    while (!waiting.empty()) {
      const Index from = waiting.back();
      waiting.pop_back();
      for (const Index to : neighbours[static_cast<std::size_t>(from)]) {
        if (reached[static_cast<std::size_t>(to)] != 0) continue;
        reached[static_cast<std::size_t>(to)] = 1;
        body.walk.push_back({from, to});
        waiting.push_back(to);
      }
    }
  }
}

}  // namespace

std::optional<ClosedBody> closed_body(const Surface& surface, Index body) {
  ClosedBody closed;
  for (Index triangle = 0; triangle < static_cast<Index>(surface.triangles().rows()); ++triangle)
    if (surface.body_of(surface.triangles()(triangle, 0)) == body) closed.triangles.push_back(triangle);
  if (closed.triangles.empty()) return std::nullopt;
  auto edges = paired_edges(surface, closed.triangles);
  if (!edges) return std::nullopt;
  closed.edges = std::move(*edges);
  walk_over(closed, surface.vertex_count());
  return closed;
}

double winding_number(const Surface& surface, const ClosedBody& body, const Positions& q, const Vector3& point) {
  double sum = 0;
  for (const Index triangle : body.triangles) {
    const auto corners = surface.triangles().row(triangle);
    const Vector3 a = q.row(corners[0]).transpose() - point, b = q.row(corners[1]).transpose() - point,
                  c = q.row(corners[2]).transpose() - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace stiv
