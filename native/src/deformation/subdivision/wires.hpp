// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "deformation/linear/weight_rows.hpp"
#include "deformation/subdivision/cage_edges.hpp"

namespace stiv {

/// Subdivision of a cage's loose edges and vertices. Chains of loose edges become uniform cubic B-splines. Where a
/// chain ends, branches or meets a face, it is extrapolated linearly.
class Wires {
 public:
  /// Refers to the cage, which must outlive it.
  /// @param smooth false: edges stay straight and vertices in place (the modifier's type "Simple")
  Wires(const Cage& cage, const CageEdges& edges, bool smooth);

  /// True if the vertex has a loose edge.
  bool touches(Index vertex) const { return edge_count_[at(vertex)] > 0; }

  /// Weights of a vertex in no face: (1, 4, 1) / 6 inside a chain, else 1 for itself.
  void add_vertex(Index vertex, WeightRows& rows) const;

  /// Weights of the point at `fraction` in (0, 1) of a loose edge, from its first end.
  void add_edge_point(Index edge, double fraction, WeightRows& rows) const;

 private:
  Index neighbour(Index vertex, Index except) const;

  const Cage& cage_;
  bool smooth_;
  std::vector<bool> on_face_;
  std::vector<Index> edge_count_;                 ///< loose edges of each vertex
  std::vector<std::array<Index, 2>> neighbours_;  ///< other ends of its first two loose edges
};

}  // namespace stiv
