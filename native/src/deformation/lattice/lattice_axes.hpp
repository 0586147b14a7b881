// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>

#include "deformation/cubic_weights.hpp"
#include "stiv/deformation/lattice.hpp"

namespace stiv {

/// The points of a lattice along one axis, which stand at equal distances.
struct LatticeAxis {
  Index count = 1;
  LatticeInterpolation interpolation = LatticeInterpolation::bspline;
  double first = 0, spacing = 1;

  /// Beyond the ends the outermost points stand in for those that are missing.
  Index point(Index place) const { return std::clamp(place, 0, count - 1); }
};

/// The four points in a row that act along an axis, and their weights.
struct AxisWeights {
  Index first = 0;  ///< a place that may lie beyond the ends, see LatticeAxis::point
  FourWeights weight{};
};

AxisWeights axis_weights(const LatticeAxis& axis, double coordinate);

/// @throws InputError if points along an axis coincide
std::array<LatticeAxis, 3> lattice_axes(const LatticeDefinition& lattice);

/// By what the rows of lattice_weights are scaled; same arguments, which are known to fit.
Eigen::VectorXd lattice_factors(const LatticeDefinition& lattice, const Positions& rest_vertices,
                                const Eigen::VectorXd& influence);

}  // namespace stiv
