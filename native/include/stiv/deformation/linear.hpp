// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "stiv/deformation/deformation.hpp"

namespace stiv {

/// q = p: one control for each vertex. The metric is the identity.
std::shared_ptr<const Deformation> make_identity(Index vertex_count);

/// Weights of controls at vertices, (n, m), the same for x, y and z.
using WeightMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, Index>;

/// Weights from compressed rows. Those of vertex i are values[starts[i]] to values[starts[i + 1] - 1], for the controls
/// at the same positions of `controls`, in any order. Repeated entries add up.
/// @throws InputError naming the row: lists of the wrong length, a control out of range
WeightMatrix weights_from_rows(const std::vector<Index>& starts, const std::vector<Index>& controls,
                               const std::vector<double>& values, Index control_count);

/// A deformation q = M p + c with explicit weights.
class LinearDeformation : public Deformation {
 public:
  virtual const WeightMatrix& weights() const = 0;  ///< M, (n, m)
  virtual const Positions& offset() const = 0;      ///< c, (n, 3), or (0, 3) for none
};

/// q = M p + c. Subdivisions, lattices and their compositions are of this kind.
/// @param offset (n, 3), or (0, 3) for none
/// @throws InputError naming the row: weights or offset not finite, shapes that do not match
std::shared_ptr<const LinearDeformation> make_linear(WeightMatrix matrix, Positions offset = Positions());

/// A deformation that a linear one may follow (make_composition).
class ComposableDeformation : public Deformation {
 public:
  using Deformation::metric;

  /// The metric of E = 1/2 |S f(p) - S f(p~)|^2 for a linear deformation S that follows.
  /// @param surface_gram S'S, (n, n)
  virtual std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const = 0;
};

}  // namespace stiv
