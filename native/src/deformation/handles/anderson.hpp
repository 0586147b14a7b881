// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>

#include "stiv/types.hpp"

namespace stiv {

/// Anderson acceleration of a fixed-point iteration x = g(x): the next point from the last few points and their images,
/// such that the residuals g(x) - x, taken as linear, cancel best. [Anderson 1965; for local and global steps: Peng et
/// al. 2018]
class AndersonAcceleration {
 public:
  /// The next point after x, of which g is the image.
  Positions next(const Positions& x, const Positions& g);

  /// Forget all points: they led astray.
  void restart() { *this = {}; }

 private:
  struct Difference {
    Positions residual, image;
  };
  void add(Difference difference);

  std::deque<Difference> differences_;
  Eigen::MatrixXd products_;  // of the residuals' differences
  Positions last_residual_, last_image_;
  bool has_last_ = false;
};

}  // namespace stiv
