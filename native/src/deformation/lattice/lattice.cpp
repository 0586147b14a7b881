// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/lattice.hpp"

#include <cmath>
#include <string>

#include "deformation/checks.hpp"
#include "deformation/lattice/lattice_axes.hpp"
#include "deformation/linear/weight_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

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

/// Weights of all points at one position; a point occurs once for each of its places.
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
        const Index along_u = axes[0].point(u.first + static_cast<Index>(a)),
                    along_v = axes[1].point(v.first + static_cast<Index>(b)),
                    along_w = axes[2].point(w.first + static_cast<Index>(c));
        result.point.push_back((along_w * axes[1].count + along_v) * axes[0].count + along_u);
        result.weight.push_back(u.weight[a] * v.weight[b] * w.weight[c]);
      }
}

/// Product of strength, modifier group and the lattice's own group. The last one blends with the undeformed position.
/// Blender applies strength and modifier group both to the offset and to that blend.
double row_factor(const LatticeDefinition& lattice, const PointWeights& weights, double influence) {
  if (lattice.point_weights.size() == 0) return influence;
  double blend = 0;
  for (std::size_t k = 0; k < weights.point.size(); ++k)
    blend += weights.weight[k] * lattice.point_weights[weights.point[k]];
  return influence * influence * blend;
}

}  // namespace

Eigen::VectorXd lattice_factors(const LatticeDefinition& lattice, const Positions& rest_vertices,
                                const Eigen::VectorXd& influence) {
  const std::array<LatticeAxis, 3> axes = lattice_axes(lattice);
  Eigen::VectorXd factors(rest_vertices.rows());
  PointWeights weights;
  for (Index vertex = 0; vertex < factors.size(); ++vertex) {
    weights_at(axes, rest_vertices.row(vertex), weights);
    factors[vertex] = row_factor(lattice, weights, influence.size() > 0 ? influence[vertex] : 1);
  }
  return factors;
}

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
