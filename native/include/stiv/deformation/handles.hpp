// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// Edge weights of a mesh's Laplacian.
enum class EdgeWeights {
  uniform,   ///< all 1
  cotangent  ///< (cot a + cot b) / 2 of the angles opposite the edge at rest, at least 1/1000
};

/// A mesh moved by handles. Control k is the position of vertex handles[k]. Fixed vertices, and connected components
/// without a handle, stay at rest. All other vertices follow the handles.
struct HandleDefinition {
  Positions rest;              ///< (n, 3)
  Triangles triangles;         ///< (F, 3)
  std::vector<Index> handles;  ///< (m) vertices, each once
  Eigen::VectorXd pull;        ///< (m) > 0: stiffness of soft handles; empty: hard handles
  std::vector<Index> fixed;    ///< vertices that never move, none of them a handle
  EdgeWeights edge_weights = EdgeWeights::uniform;
};

/// A deformation by handles.
class HandleDeformation : public ComposableDeformation {};

/// Laplacian editing [Sorkine et al. 2004; App. B, Eq. 4]: q minimizes |L (q - rest)|^2 + sum pull_k |q_h(k) - p_k|^2.
/// Each row of the Laplacian L is divided by its diagonal. Hard handles and fixed vertices are constraints instead.
/// Linear in the controls. The factor is computed once. Up to 256 MB, the weights of all handles are stored too, so
/// that products with J are cheap; beyond that, each is a solve. At the rest controls, q is `rest` bit for bit.
/// @throws InputError naming the element: a triangle, handle or fixed vertex out of range, a handle repeated or fixed,
///         a position or pull not finite, a pull not positive
std::shared_ptr<const HandleDeformation> make_laplacian(const HandleDefinition& definition);

/// As-rigid-as-possible editing [Sorkine and Alexa 2007]: q minimizes
///   1/4 sum_i sum_j w_ij |(q_i - q_j) - R_i (rest_i - rest_j)|^2 + 1/2 sum_k pull_k |q_h(k) - p_k|^2
/// over positions and one rotation R_i for each vertex. Hard handles and fixed vertices are constraints instead. Not
/// linear in the controls.
/// The minimum is computed from the rest positions, so that it depends on the controls alone. Local and global steps
/// alternate until a step moves no vertex by more than 1e-11 of the mesh's size, at most 300 times. J is the exact
/// derivative at the minimum, and the last linearisation is cached. The metric neglects the change of rotations.
/// @throws InputError as make_laplacian
std::shared_ptr<const HandleDeformation> make_arap(const HandleDefinition& definition);

}  // namespace stiv
