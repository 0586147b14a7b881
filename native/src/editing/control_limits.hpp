// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/acceptance/storage.hpp"
#include "stiv/deformation/metric.hpp"
#include "stiv/response/resolver.hpp"

namespace stiv {

/// The limits of scalar controls during edits.
class ControlLimits {
 public:
  /// @param frames of the controls as stored: limits are rounded to single precision there, inward
  /// @throws InputError if a scalar is stored in a frame that is not the identity
  ControlLimits(ScalarRows scalars, const std::vector<StorageFrame>& frames);

  const std::vector<Index>& rows() const { return scalars_.rows; }

  /// @throws InputError naming a control outside its limits
  void check(const Controls& p) const;

  bool contain(const Controls& p) const;

  /// The nearest controls within the limits.
  Controls nearest(Controls p) const;

  /// The same for controls as stored. Scalars have exactly the value that is read back.
  Controls nearest_stored(Controls p) const;

  /// The largest fraction, at most 1, of the step between two controls that no longest step is less than.
  double fraction_of_longest_step(const Controls& from, const Controls& to) const;

  /// Constraints for limits that p exceeds and `constraints` do not contain yet.
  std::vector<ControlConstraint> exceeded(const Controls& p, const ConstraintSet& constraints, const Metric& metric,
                                          const Controls& metric_at) const;

 private:
  ScalarRows scalars_;
  Eigen::VectorXd lower_, upper_;         ///< as stored
  std::vector<unsigned char> is_stored_;  ///< in single precision
};

}  // namespace stiv
