// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "deformation/lattice/lattice_axes.hpp"
#include "stiv/execution.hpp"

namespace stiv {

/// The weights of a lattice's points in vertices as what they are products of, four along each axis: twelve numbers a
/// vertex instead of 64 with their indices, which do not fit into the processor's cache.
class LatticeSums {
 public:
  /// @param places (n, 3) of the vertices in the lattice's frame
  /// @param factors (n) of the rows
  LatticeSums(const std::array<LatticeAxis, 3>& axes, const Positions& places, const Eigen::VectorXd& factors);

  /// W p, (n, 3): along w, then v, then u, none fused: the same bits whatever the width of vectors and the number of
  /// threads.
  Positions sum(const Controls& p, const Execution& execution) const;
  /// Rows of that, (k, 3).
  Positions sum(const Controls& p, std::span<const Index> vertices, const Execution& execution) const;

 private:
  struct Axis {
    Index first = 0, count = 0;  ///< the places along an axis that act on any vertex, those beyond the ends among them
  };

  Positions sum(const Controls& p, const Index* vertices, Index count, const Execution& execution) const;

  std::array<Axis, 3> axes_;
  std::vector<Index> points_;    ///< the lattice's point at each place, u fastest
  std::vector<double> weights_;  ///< (n, 3, 4) along u, v and w; the last ones times the factor
  std::vector<Index> starts_;    ///< (n) the first of the places that act on a vertex
};

}  // namespace stiv
