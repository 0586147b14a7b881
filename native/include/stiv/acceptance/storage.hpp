// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Controls [first, first + count) are stored in single precision in a frame of their own: what comes back after
/// storing world position x is frame * float32(frame^-1 * x), in double precision. `frame` is affine, local to world,
/// and invertible.
struct StorageFrame {
  Index first = 0;
  Index count = 0;
  Eigen::Matrix4d frame = Eigen::Matrix4d::Identity();
};

/// The controls as they will be read back after storing, (m, 3); those that storing changes by no more than the
/// rounding of doubles, and those in no frame, stay as they are bit by bit. So it is idempotent, and what has been read
/// from storage does not change. (mathematics.md, "Values as stored")
/// @throws InputError naming the controls: a frame that is singular, not affine or not finite; rows that there are not;
///         a local coordinate that single precision cannot hold.
Controls as_stored(const Controls& p, const std::vector<StorageFrame>& frames);

}  // namespace stiv
