// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>

#include "stiv/detection/narrow_phase.hpp"

namespace stiv {

/// Random motions of four vertices, of one kind that is hard to test.
class MotionMaker {
 public:
  explicit MotionMaker(unsigned seed) : random_(seed) {}

  enum Sort { general, coplanar, grid, sliver, collapsing, rotating, far_away, sort_count };

  PairMotion make(int sort) {
    PairMotion motion;
    for (std::size_t k = 0; k < 4; ++k) {
      motion.start[k] = point();
      motion.end[k] = point();
    }
    if (sort == coplanar) flatten(motion);
    if (sort == grid) snap(motion);
    if (sort == sliver) thin(motion);
    if (sort == collapsing) motion.end[3] = motion.end[2];
    if (sort == rotating) rotate(motion);
    if (sort == far_away) shift(motion, 1e4);
    return motion;
  }

  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  Vector3 point() { return {number(-1, 1), number(-1, 1), number(-1, 1)}; }

  void flatten(PairMotion& motion) {
    for (std::size_t k = 0; k < 4; ++k) motion.start[k][2] = motion.end[k][2] = 0;
  }

  void snap(PairMotion& motion) {
    for (std::size_t k = 0; k < 4; ++k) {
      motion.start[k] = (2 * motion.start[k]).array().round();
      motion.end[k] = (2 * motion.end[k]).array().round();
    }
  }

  void thin(PairMotion& motion) {
    motion.start[3] = motion.start[1] + number(0, 1) * (motion.start[2] - motion.start[1]) + 1e-9 * point();
    motion.end[3] = motion.end[1] + number(0, 1) * (motion.end[2] - motion.end[1]) + 1e-9 * point();
  }

  /// The whole end turned by an angle, so that the far side is much faster than the contact.
  void rotate(PairMotion& motion) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(number(0, 1.5), point().normalized()).toRotationMatrix();
    for (std::size_t k = 1; k < 4; ++k) motion.end[k] = turn * motion.start[k];
    motion.end[0] = motion.start[0] - 0.5 * number(0, 1) * motion.start[0];
  }

  void shift(PairMotion& motion, double offset) {
    for (std::size_t k = 0; k < 4; ++k) {
      motion.start[k].array() += offset;
      motion.end[k].array() += offset;
    }
  }

  std::mt19937 random_;
};

}  // namespace stiv
