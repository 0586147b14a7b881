// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "stiv/deformation/handles.hpp"

namespace stiv {

/// The frame in which controls [first, first + count) are stored in single precision. A control stored at world
/// position x is read back as frame * float32(frame^-1 * x), in double precision.
struct StorageFrame {
  Index first = 0;
  Index count = 0;
  Eigen::Matrix4d frame = Eigen::Matrix4d::Identity();  ///< local to world, affine and invertible
};

/// The controls as they are read back from storage, (m, 3). Controls in no frame, and controls that storage changes by
/// no more than the rounding of doubles, are returned bit for bit. The function is therefore idempotent, and stored
/// values stay as they are. (mathematics.md, "Values as stored")
/// @throws InputError naming the controls: a frame singular, not affine or not finite; rows out of range; a local
///         coordinate out of the range of single precision
Controls as_stored(const Controls& p, const std::vector<StorageFrame>& frames);

/// A mesh moved by handles of which the vertices are stored instead of the controls. Its surface is read back from
/// single precision in `frame`, (4, 4), local to world. A subdivision of a cage then acts on the cage as it will be
/// stored. The response is that of `mesh`, since rounding has no derivative. (mathematics.md, "Values as stored")
/// @throws InputError as as_stored
std::shared_ptr<const HandleDeformation> make_stored_mesh(std::shared_ptr<const HandleDeformation> mesh,
                                                          const Eigen::Matrix4d& frame);

}  // namespace stiv
