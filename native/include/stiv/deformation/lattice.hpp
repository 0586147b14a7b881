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

/// Weights W, (n, u v w), of the lattice's points at `rest_vertices`, (n, 3), in the lattice's frame. x + W (P - R) is
/// the result of Blender's Lattice modifier. The influence, (n), is strength times modifier group; empty: all 1. With
/// point weights it applies twice, as in Blender.
/// @throws InputError for a resolution below 1, invalid sizes, and coordinates that are not finite
WeightMatrix lattice_weights(const LatticeDefinition& lattice, const Positions& rest_vertices,
                             const Eigen::VectorXd& influence = Eigen::VectorXd());

/// The vertices that a lattice deforms.
struct LatticePlacement {
  Positions rest_vertices;    ///< (n, 3), in the lattice's frame
  Eigen::VectorXd influence;  ///< (n), or empty: all 1
  Positions vertices;         ///< (n, 3) undeformed, in the world
  Controls points;            ///< (u v w, 3) rest positions of the points, in the world
};

/// q = vertices + W (p - points), with the lattice's points in the world as controls. Like make_linear with
/// lattice_weights, but products use the weights along each axis.
/// @throws InputError as lattice_weights, and if sizes do not match
std::shared_ptr<const LinearDeformation> make_lattice(const LatticeDefinition& lattice, const LatticePlacement& placed);

}  // namespace stiv
