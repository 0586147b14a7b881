// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// How the edges of a mesh count in its Laplacian.
enum class EdgeWeights {
  uniform,   ///< all alike
  cotangent  ///< (cot a + cot b) / 2 of the angles opposite to the edge at rest, no less than 1/1000
};

/// A mesh that is moved by handles: control k is the position of vertex handles[k], the fixed vertices stay where they
/// are, and all others follow. So do whole parts without any handle: they stay.
struct HandleDefinition {
  Positions rest;              ///< (n, 3)
  Triangles triangles;         ///< (F, 3)
  std::vector<Index> handles;  ///< (m) vertices, each once
  Eigen::VectorXd pull;        ///< (m) > 0: how hard each handle pulls at its vertex (soft); empty: it holds it (hard)
  std::vector<Index> fixed;    ///< vertices that never move; none of them a handle
  EdgeWeights edge_weights = EdgeWeights::uniform;
};

/// A deformation by handles, which a linear one may follow.
class HandleDeformation : public Deformation {
 public:
  using Deformation::metric;

  /// The metric of E = 1/2 |S f(p) - S f(p~)|^2 for the linear deformation S that follows.
  /// @param surface_gram S'S, (n, n)
  virtual std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const = 0;
};

}  // namespace stiv
