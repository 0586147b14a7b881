// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "deformation/linear/weight_rows.hpp"
#include "deformation/subdivision/cage_edges.hpp"

namespace stiv {

/// What becomes of the parts of a cage that are in no face. Loose edges turn into uniform cubic B-splines through the
/// chain of their neighbours; where a chain ends, branches or meets a face, it is continued in a straight line.
class Wires {
 public:
  /// The cage must outlive this.
  /// @param smooth false: edges stay straight and vertices stay put (the modifier's "Simple" type)
  Wires(const Cage& cage, const CageEdges& edges, bool smooth);

  /// Has this vertex a loose edge?
  bool touches(Index vertex) const { return edge_count_[at(vertex)] > 0; }

  /// Weights of a vertex in no face: inside a chain (1, 4, 1) / 6, else where it is.
  void add_vertex(Index vertex, WeightRows& rows) const;

  /// Weights of the point at `fraction` in (0, 1) of a loose edge, counted from its first end.
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
