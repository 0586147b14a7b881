// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>

#include "stiv/types.hpp"

namespace stiv {

/// Anderson acceleration of a fixed-point iteration x = g(x). The next point combines the last few points and their
/// images so that the residual g(x) - x, assumed to be linear, is least. [Anderson 1965; for local and global steps:
/// Peng et al. 2018]
class AndersonAcceleration {
 public:
  /// The point that follows x, whose image is g.
  Positions next(const Positions& x, const Positions& g);

  /// Forgets all points, after an extrapolation that failed.
  void restart() { *this = {}; }

 private:
  struct Difference {
    Positions residual, image;
  };
  void add(Difference difference);

  std::deque<Difference> differences_;
  Eigen::MatrixXd products_;  // inner products of the differences of residuals
  Positions last_residual_, last_image_;
  bool has_last_ = false;
};

}  // namespace stiv
