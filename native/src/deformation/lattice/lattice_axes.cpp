// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/lattice/lattice_axes.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "stiv/error.hpp"

namespace stiv {

namespace {

FourWeights interpolate(LatticeInterpolation interpolation, double t) {
  switch (interpolation) {
    case LatticeInterpolation::linear:
      return linear_weights(t);
    case LatticeInterpolation::cardinal:
      return cardinal_weights(t, 0.71);  // Blender's constant
    case LatticeInterpolation::catmull_rom:
      return cardinal_weights(t, 0.5);
    case LatticeInterpolation::bspline:
      break;
  }
  return bspline_weights(t);
}

}  // namespace

AxisWeights axis_weights(const LatticeAxis& axis, double coordinate) {
  if (axis.count == 1) return {-1, {0, 1, 0, 0}};
  const double u = (coordinate - axis.first) / axis.spacing, cell = std::floor(u);
  // Two or more cells outside, all four points are the outermost one: clamp before the conversion to an integer.
  const auto base = static_cast<Index>(std::clamp(cell, -3.0, axis.count + 1.0));
  return {base - 1, interpolate(axis.interpolation, u - cell)};
}

std::array<LatticeAxis, 3> lattice_axes(const LatticeDefinition& lattice) {
  std::array<LatticeAxis, 3> axes;
  Index stride = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    axes[k].count = lattice.resolution[k];
    axes[k].interpolation = lattice.interpolation[k];
    axes[k].first = lattice.rest(0, static_cast<Index>(k));
    if (axes[k].count > 1) axes[k].spacing = lattice.rest(stride, static_cast<Index>(k)) - axes[k].first;
    if (axes[k].spacing == 0)
      throw InputError("lattice: the rest positions of its points coincide along axis " + std::to_string(k) +
                       "; give the undeformed points");
    stride *= lattice.resolution[k];
  }
  return axes;
}

}  // namespace stiv
