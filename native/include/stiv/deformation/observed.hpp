// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// A sparse derivative dq/dp of a surface q, (n, 3), by its controls p, (m, 3), in blocks of 3 x 3.
struct Jacobian {
  WeightMatrix weights;                 ///< (n, m), compressed; if there are blocks, only their places
  std::vector<Eigen::Matrix3d> blocks;  ///< of the entries in their order; empty: each weight times the identity
};

/// Blocks from compressed rows, as weights_from_rows: block k is dq_i/dp_controls[k] for starts[i] <= k < starts[i +
/// 1].
/// @throws InputError naming the row
Jacobian jacobian_from_blocks(const std::vector<Index>& starts, const std::vector<Index>& controls,
                              const std::vector<Eigen::Matrix3d>& blocks, Index control_count);

/// A deformation whose J is sparse and does not depend on the controls.
class SparseJacobianDeformation : public ComposableDeformation {
 public:
  virtual std::shared_ptr<const Jacobian> jacobian() const = 0;
};

/// f(p), (n, 3), or nothing if there is no surface with this topology at p.
using Evaluation = std::function<std::optional<Positions>(const Controls& p)>;

/// A deformation q = f(p) by a function of the caller. J only directs the response: the less accurate it is, the less
/// of a motion remains, but each accepted state is one that f returned.
/// f depends on nothing but p. Its last value is stored, so evaluating it again at the same controls is free.
/// One thread at a time calls f: the one that calls the core, or that polls or waits for a job (Execution::call_owner).
/// @see InfeasibleError for controls where f has no value
class ObservedDeformation : public SparseJacobianDeformation {
 public:
  /// Replaces J, for all sessions of deformations that contain this one, from their next call on. Not during a call.
  /// @throws InputError for another size, or naming the row of a number that is not finite
  virtual void set_jacobian(Jacobian jacobian) = 0;
};

/// rotation_rows: ascending rows of the controls that are rotation vectors. (deformation.hpp)
/// @throws InputError naming the row of a number in J that is not finite, or a rotation row that is not a control
std::shared_ptr<ObservedDeformation> make_observed(Evaluation evaluate, Jacobian jacobian,
                                                   std::vector<Index> rotation_rows = {});

}  // namespace stiv
