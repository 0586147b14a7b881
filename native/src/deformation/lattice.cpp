// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "deformation/checks.hpp"
#include "deformation/cubic_weights.hpp"
#include "deformation/weight_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// The points of a lattice along one axis, which stand at equal distances.
struct LatticeAxis {
  Index count = 1;
  LatticeInterpolation interpolation = LatticeInterpolation::bspline;
  double first = 0, spacing = 1;
};

/// Which points along an axis act at a coordinate, and with what weight; indices may repeat.
struct AxisWeights {
  std::array<Index, 4> index{};
  FourWeights weight{};
};

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

/// Beyond the ends the outermost points stand in for those that are missing.
AxisWeights axis_weights(const LatticeAxis& axis, double coordinate) {
  if (axis.count == 1) return {{0, 0, 0, 0}, {0, 1, 0, 0}};
  const double u = (coordinate - axis.first) / axis.spacing, cell = std::floor(u);
  // Two cells outside all four points are the same one: the cell may be clamped there before it becomes an integer.
  const auto base = static_cast<Index>(std::clamp(cell, -3.0, axis.count + 1.0));
  AxisWeights weights;
  weights.weight = interpolate(axis.interpolation, u - cell);
  for (Index k = 0; k < 4; ++k)
    weights.index[static_cast<std::size_t>(k)] = std::clamp(base - 1 + k, 0, axis.count - 1);
  return weights;
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

void check_lattice(const LatticeDefinition& lattice) {
  std::int64_t count = 1;
  for (const Index points : lattice.resolution) {
    if (points < 1 || points > 64) throw InputError("lattice: resolution must be 1 to 64 along each axis");
    count *= points;
  }
  if (lattice.rest.rows() != count)
    throw InputError("lattice: " + std::to_string(lattice.rest.rows()) + " rest positions for " +
                     std::to_string(count) + " points; give one for each");
  if (lattice.point_weights.size() != 0 && lattice.point_weights.size() != count)
    throw InputError("lattice: " + std::to_string(lattice.point_weights.size()) + " point weights for " +
                     std::to_string(count) + " points; give one for each, or none");
  check_finite(lattice.rest, "lattice, rest position of point");
  for (Index point = 0; point < lattice.point_weights.size(); ++point)
    if (!std::isfinite(lattice.point_weights[point]))
      throw InputError("lattice, point " + std::to_string(point) + ": weight is not finite");
}

void check_influence(const Eigen::VectorXd& influence, Eigen::Index vertex_count) {
  if (influence.size() != 0 && influence.size() != vertex_count)
    throw InputError("lattice: influence has " + std::to_string(influence.size()) + " values for " +
                     std::to_string(vertex_count) + " vertices; give one for each, or none");
  for (Index vertex = 0; vertex < influence.size(); ++vertex)
    if (!std::isfinite(influence[vertex]))
      throw InputError("lattice, vertex " + std::to_string(vertex) + ": influence is not finite");
}

/// Weights of all points at one place, each point once for each way to reach it.
struct PointWeights {
  std::vector<Index> point;
  std::vector<double> weight;
};

void weights_at(const std::array<LatticeAxis, 3>& axes, const Vector3& place, PointWeights& result) {
  result.point.clear();
  result.weight.clear();
  const AxisWeights u = axis_weights(axes[0], place.x()), v = axis_weights(axes[1], place.y()),
                    w = axis_weights(axes[2], place.z());
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t b = 0; b < 4; ++b)
      for (std::size_t a = 0; a < 4; ++a) {
        result.point.push_back((w.index[c] * axes[1].count + v.index[b]) * axes[0].count + u.index[a]);
        result.weight.push_back(u.weight[a] * v.weight[b] * w.weight[c]);
      }
}

/// Strength, modifier group and the lattice's own group. The last one blends with the undeformed place, by a factor
/// into which strength and modifier group enter once more: Blender applies them to the offset and to the blend.
double row_factor(const LatticeDefinition& lattice, const PointWeights& weights, double influence) {
  if (lattice.point_weights.size() == 0) return influence;
  double blend = 0;
  for (std::size_t k = 0; k < weights.point.size(); ++k)
    blend += weights.weight[k] * lattice.point_weights[weights.point[k]];
  return influence * influence * blend;
}

}  // namespace

WeightMatrix lattice_weights(const LatticeDefinition& lattice, const Positions& rest_vertices,
                             const Eigen::VectorXd& influence) {
  check_lattice(lattice);
  check_finite(rest_vertices, "lattice, vertex");
  check_influence(influence, rest_vertices.rows());
  const std::array<LatticeAxis, 3> axes = lattice_axes(lattice);
  WeightRows rows(static_cast<Index>(rest_vertices.rows()), static_cast<Index>(lattice.rest.rows()));
  PointWeights weights;
  for (Index vertex = 0; vertex < rest_vertices.rows(); ++vertex) {
    weights_at(axes, rest_vertices.row(vertex), weights);
    const double factor = row_factor(lattice, weights, influence.size() > 0 ? influence[vertex] : 1);
    for (std::size_t k = 0; k < weights.point.size(); ++k) rows.add(weights.point[k], factor * weights.weight[k]);
    rows.end_row();
  }
  return rows.matrix();
}

}  // namespace stiv
