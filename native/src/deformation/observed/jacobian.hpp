// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "deformation/metric/sparse_factor.hpp"
#include "stiv/deformation/observed.hpp"

namespace stiv {

/// @throws InputError naming the row of a number that is not finite
void check_jacobian(const Jacobian& jacobian);

/// Products with a Jacobian, which it stores by rows and by columns.
class JacobianProducts {
 public:
  explicit JacobianProducts(Jacobian jacobian);

  const Jacobian& jacobian() const { return jacobian_; }
  bool has_blocks() const { return !jacobian_.blocks.empty(); }
  Index vertex_count() const { return static_cast<Index>(jacobian_.weights.rows()); }
  Index control_count() const { return static_cast<Index>(jacobian_.weights.cols()); }

  SparseField pull_back(const SparseField& g) const;
  Positions push_forward(const Controls& d) const;
  std::vector<Index> support(Index control) const;

  /// The lower triangle of J'GJ, (3 m, 3 m).
  /// @param surface_gram G, (n, n), the same for x, y and z; null: the identity
  SymmetricMatrix block_gram(const WeightMatrix* surface_gram) const;

  /// The same without couplings of different axes: for each axis, (m, m).
  std::array<SymmetricMatrix, 3> axis_grams(const WeightMatrix* surface_gram) const;

  /// The same with a third of the trace for each block, (m, m): exact for weights.
  SymmetricMatrix mean_gram(const WeightMatrix* surface_gram) const;

 private:
  template <class Use>
  void for_gram_terms(Index column, const WeightMatrix* surface_gram, const Use& use) const;

  Jacobian jacobian_;
  // By controls: vertices, ascending, and entries of the rows.
  std::vector<Index> column_starts_, column_rows_, column_entries_;
};

/// J of outer(inner(p)).
Jacobian product(const Jacobian& outer, const Jacobian& inner);

}  // namespace stiv
