// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "stiv/deformation/deformation.hpp"

namespace stiv {

/// Weights of controls in vertices, (n, m), the same for x, y and z.
using WeightMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, Index>;

/// Weights from compressed rows: those of vertex i are values[starts[i]] to values[starts[i + 1] - 1], of the controls
/// at the same places of `controls`, in any order; weights of one control in one row add up.
/// @throws InputError naming the row: lists that do not fit, a control out of range.
WeightMatrix weights_from_rows(const std::vector<Index>& starts, const std::vector<Index>& controls,
                               const std::vector<double>& values, Index control_count);

/// A deformation q = M p + c whose weights can be looked at.
class LinearDeformation : public Deformation {
 public:
  virtual const WeightMatrix& weights() const = 0;  ///< M, (n, m)
  virtual const Positions& offset() const = 0;      ///< c, (n, 3), or (0, 3) for none
};

/// q = M p + c. Every linear deformation (subdivision, lattice, their chains) becomes one of these.
/// @param offset (n, 3), or (0, 3) for none
/// @throws InputError naming the row: weights or offset not finite, shapes that do not fit.
std::shared_ptr<const LinearDeformation> make_linear(WeightMatrix matrix, Positions offset = Positions());

}  // namespace stiv
