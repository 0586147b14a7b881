// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/mesh_laplacian.hpp"

#include <algorithm>
#include <cmath>

namespace stiv {

namespace {

using Triplets = std::vector<Eigen::Triplet<double, Index>>;

/// Bounds of edge weights, so that the Laplacian stays definite: obtuse triangles can make the sum of an edge's
/// cotangents zero or negative, and slivers can make it arbitrarily large.
constexpr double least_weight = 1e-3;
constexpr double most_cotangent = 1e3;

/// Half the cotangent of the angle at `apex`, clamped; 0 if a side has no length.
double half_cotangent(const Vector3& apex, const Vector3& a, const Vector3& b) {
  const double cosine = (a - apex).dot(b - apex), sine = (a - apex).cross(b - apex).norm();
  if (std::abs(cosine) > most_cotangent * sine) return std::copysign(most_cotangent / 2, cosine);
  return sine > 0 ? cosine / sine / 2 : 0;
}

void add_both_ways(Triplets& entries, Index a, Index b, double value) {
  entries.emplace_back(a, b, value);
  entries.emplace_back(b, a, value);
}

Triplets cotangents(const Triangles& triangles, const Positions& rest) {
  Triplets entries;
  for (Index face = 0; face < triangles.rows(); ++face)
    for (Index k = 0; k < 3; ++k) {
      const Index apex = triangles(face, k), a = triangles(face, (k + 1) % 3), b = triangles(face, (k + 2) % 3);
      if (a != b) add_both_ways(entries, a, b, half_cotangent(rest.row(apex), rest.row(a), rest.row(b)));
    }
  return entries;
}

Triplets ones(const Edges& edges) {
  Triplets entries;
  for (Index edge = 0; edge < edges.rows(); ++edge) add_both_ways(entries, edges(edge, 0), edges(edge, 1), 1);
  return entries;
}

}  // namespace

SymmetricMatrix edge_weights(const Surface& mesh, const Positions& rest, EdgeWeights kind) {
  const Triplets entries = kind == EdgeWeights::uniform ? ones(mesh.edges()) : cotangents(mesh.triangles(), rest);
  SymmetricMatrix weights(mesh.vertex_count(), mesh.vertex_count());
  weights.setFromTriplets(entries.begin(), entries.end());
  for (Index k = 0; k < weights.nonZeros(); ++k) weights.valuePtr()[k] = std::max(weights.valuePtr()[k], least_weight);
  return weights;
}

SymmetricMatrix mesh_laplacian(const SymmetricMatrix& weights) {
  const Eigen::VectorXd sums = weights * Eigen::VectorXd::Ones(weights.cols());
  SymmetricMatrix diagonal(weights.rows(), weights.cols());
  diagonal.setIdentity();
  diagonal.diagonal() = sums;
  return diagonal - weights;
}

SymmetricMatrix squared_laplacian(const SymmetricMatrix& weights) {
  SymmetricMatrix laplacian = mesh_laplacian(weights);
  const Eigen::VectorXd sums = laplacian.diagonal();
  for (Index column = 0; column < laplacian.cols(); ++column)
    for (SymmetricMatrix::InnerIterator entry(laplacian, column); entry; ++entry)
      if (sums[entry.row()] > 0) entry.valueRef() /= sums[entry.row()];
  return SymmetricMatrix(laplacian.transpose()) * laplacian;
}

}  // namespace stiv
