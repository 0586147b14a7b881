// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// Interpolation along one axis of a lattice; names as in Blender.
enum class LatticeInterpolation { linear, cardinal, catmull_rom, bspline };

struct LatticeDefinition {
  std::array<Index, 3> resolution{2, 2, 2};  ///< points along u, v, w
  std::array<LatticeInterpolation, 3> interpolation{LatticeInterpolation::bspline, LatticeInterpolation::bspline,
                                                    LatticeInterpolation::bspline};
  Positions rest;                 ///< (u v w, 3) rest positions of the points, u fastest, in the lattice's frame
  Eigen::VectorXd point_weights;  ///< (u v w) weights of the lattice's own vertex group, or empty: all 1
};

/// Weights of the lattice's points in vertices at `rest_vertices` (n, 3), given in the lattice's frame, so that
///   x_out = x + W (P - R)   (rows of W scaled by `influence`, (n), strength times modifier group; empty: all 1),
/// equal to Blender's Lattice modifier. With point weights the influence enters twice, as it does in Blender.
/// @throws InputError: a resolution below 1, sizes that do not fit, coordinates not finite.
WeightMatrix lattice_weights(const LatticeDefinition& lattice, const Positions& rest_vertices,
                             const Eigen::VectorXd& influence = Eigen::VectorXd());

/// What a lattice deforms, and where.
struct LatticePlacement {
  Positions rest_vertices;    ///< (n, 3), in the lattice's frame
  Eigen::VectorXd influence;  ///< (n), or empty: all 1
  Positions vertices;         ///< (n, 3) undeformed, in the world
  Controls points;            ///< (u v w, 3) rest positions of the points, in the world
};

/// q = vertices + W (p - points), whose controls are the lattice's points in the world. As make_linear with the weights
/// above, but the product is made from the weights along each axis.
/// @throws InputError as lattice_weights, and where sizes do not fit
std::shared_ptr<const LinearDeformation> make_lattice(const LatticeDefinition& lattice, const LatticePlacement& placed);

}  // namespace stiv
