// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "deformation/lattice/lattice_axes.hpp"
#include "stiv/execution.hpp"

namespace stiv {

/// Which rows of W p to compute, and where they go.
struct LatticeRows {
  const Positions* offset = nullptr;  ///< (n, 3) added to W p; null: nothing
  std::span<const Index> vertices{};  ///< empty: all
  std::span<const Index> places{};    ///< of the rows in the result; empty: in order
};

/// The weights of a lattice's points, factored into four weights along each axis: twelve numbers for each vertex
/// instead of 64 with indices, which do not fit into the processor's cache.
class LatticeSums {
 public:
  /// @param places (n, 3) positions of the vertices in the lattice's frame
  /// @param factors (n) of the rows of W
  LatticeSums(const std::array<LatticeAxis, 3>& axes, const Positions& places, const Eigen::VectorXd& factors);

  /// W p, (n, 3), summed along w, then v, then u, none fused: same bits for any vector width and number of threads.
  Positions sum(const Controls& p, const Execution& execution) const;
  /// Writes rows of W p, with the same bits.
  void put(const Controls& p, const LatticeRows& rows, Positions& sums, const Execution& execution) const;

 private:
  struct Axis {
    Index first = 0, count = 0;  ///< places along an axis in use, beyond the ends included
  };

  Index vertex_count() const { return static_cast<Index>(starts_.size()); }

  std::array<Axis, 3> axes_;
  std::vector<Index> points_;    ///< point at each place, u fastest
  std::vector<double> weights_;  ///< (n, 3, 4) along u, v and w; those along w times the factor
  std::vector<Index> starts_;    ///< (n) first place of each vertex
};

}  // namespace stiv
