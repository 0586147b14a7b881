// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "deformation/handles/rotation_fit.hpp"
#include "deformation/metric/sparse_factor.hpp"
#include "stiv/execution.hpp"

namespace stiv {

/// The cells of as-rigid-as-possible editing: each vertex with its edges, at rest and turned. [Sorkine and Alexa 2007]
class RigidCells {
 public:
  /// @param weights of the edges, (n, n)
  RigidCells(const SymmetricMatrix& weights, Positions rest);

  /// The local step: the rotation of each cell from rest to positions rest + u.
  /// @throws Interrupted
  std::vector<RotationFit> fit(const Positions& u, const Execution& execution) const;
  /// The same, starting from the rotations at nearby positions. The error is about the square of the turns between
  /// them.
  std::vector<RotationFit> fit(const Positions& u, const std::vector<RotationFit>& nearby,
                               const Execution& execution) const;

  /// 1/4 sum_i sum_j w_ij |(u_i - u_j) - (R_i - 1)(rest_i - rest_j)|^2.
  double energy(const Positions& u, const std::vector<RotationFit>& fits) const;

  /// The right-hand side of the global step: minus the gradient of the energy at u = 0 with these rotations.
  Positions load(const std::vector<RotationFit>& fits) const;

  /// The change of the load that a change du of the positions causes through the rotations; a symmetric linear map.
  Positions load_change(const std::vector<RotationFit>& fits, const Positions& du) const;

  /// Calls visit(row, column, block) with the blocks of that map's matrix C. The blocks of each pair of vertices add
  /// up. C = 1/2 sum_i T_i' response_i T_i with T_i du = sum_j w_ij rest_ij x R_i' du_ij, the torque on cell i.
  void visit_load_blocks(const std::vector<RotationFit>& fits,
                         const std::function<void(Index, Index, const Eigen::Matrix3d&)>& visit) const;

 private:
  /// sum_j w_ij (q_i - q_j) (rest_i - rest_j)', q = rest + u.
  Eigen::Matrix3d spread(const Positions& u, Index vertex) const;
  Positions load_of(const std::vector<Eigen::Matrix3d>& change) const;

  SymmetricMatrix weights_;
  Positions rest_;
};

}  // namespace stiv
