// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>

#include "deformation/cubic_weights.hpp"
#include "stiv/deformation/lattice.hpp"

namespace stiv {

/// The equidistant points of a lattice along one axis.
struct LatticeAxis {
  Index count = 1;
  LatticeInterpolation interpolation = LatticeInterpolation::bspline;
  double first = 0, spacing = 1;

  /// The point at a place; places beyond the ends are the outermost points.
  Index point(Index place) const { return std::clamp(place, 0, count - 1); }
};

/// Four consecutive points along an axis and their weights.
struct AxisWeights {
  Index first = 0;  ///< may lie beyond the ends, see LatticeAxis::point
  FourWeights weight{};
};

AxisWeights axis_weights(const LatticeAxis& axis, double coordinate);

/// @throws InputError if points along an axis coincide
std::array<LatticeAxis, 3> lattice_axes(const LatticeDefinition& lattice);

/// The factors of the rows of lattice_weights, for the same arguments, which are already checked.
Eigen::VectorXd lattice_factors(const LatticeDefinition& lattice, const Positions& rest_vertices,
                                const Eigen::VectorXd& influence);

}  // namespace stiv
