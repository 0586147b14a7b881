// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/subdivision/wires.hpp"

#include "deformation/cubic_weights.hpp"

namespace stiv {

Wires::Wires(const Cage& cage, const CageEdges& edges, bool smooth)
    : cage_(cage),
      smooth_(smooth),
      on_face_(static_cast<std::size_t>(cage.vertex_count), false),
      edge_count_(static_cast<std::size_t>(cage.vertex_count), 0),
      neighbours_(static_cast<std::size_t>(cage.vertex_count), {-1, -1}) {
  for (const Index vertex : cage.face_corners) on_face_[at(vertex)] = true;
  for (Index edge = 0; edge < cage.edges.rows(); ++edge) {
    if (!edges.is_loose(edge)) continue;
    for (Index end = 0; end < 2; ++end) {
      const auto vertex = static_cast<std::size_t>(cage.edges(edge, end));
      if (edge_count_[vertex] < 2) neighbours_[vertex][at(edge_count_[vertex])] = cage.edges(edge, 1 - end);
      ++edge_count_[vertex];
    }
  }
}

void Wires::add_vertex(Index vertex, WeightRows& rows) const {
  const auto v = static_cast<std::size_t>(vertex);
  if (!smooth_ || edge_count_[v] != 2) return rows.add(vertex, 1);
  rows.add(neighbours_[v][0], 1.0 / 6);
  rows.add(vertex, 4.0 / 6);
  rows.add(neighbours_[v][1], 1.0 / 6);
}

/// The next vertex of the chain after `vertex`, other than `except`; -1 if the chain ends, branches or meets a face.
Index Wires::neighbour(Index vertex, Index except) const {
  const auto v = static_cast<std::size_t>(vertex);
  if (on_face_[v] || edge_count_[v] != 2) return -1;
  return neighbours_[v][0] == except ? neighbours_[v][1] : neighbours_[v][0];
}

void Wires::add_edge_point(Index edge, double fraction, WeightRows& rows) const {
  const Index a = cage_.edges(edge, 0), b = cage_.edges(edge, 1);
  const std::array<double, 4> weight = smooth_ ? bspline_weights(fraction) : linear_weights(fraction);
  const auto add_beyond = [&](Index end, Index other, double w) {
    const Index beyond = neighbour(end, other);
    if (beyond >= 0) return rows.add(beyond, w);
    rows.add(end, 2 * w);
    rows.add(other, -w);
  };
  add_beyond(a, b, weight[0]);
  rows.add(a, weight[1]);
  rows.add(b, weight[2]);
  add_beyond(b, a, weight[3]);
}

}  // namespace stiv
