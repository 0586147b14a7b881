// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "editing/session_implementation.hpp"
#include "stiv/editing/obstacle.hpp"

namespace stiv {

/// A session with obstacles: a session over a box around the motion, with the triangles of obstacles that touch it.
/// Accepted states stay in the box, at a margin of more than the separation, so neither they nor the linear steps
/// between them can intersect the other triangles. Once a call leaves the box, it is made again in another box.
/// @throws as EditSession
std::unique_ptr<SessionImplementation> make_obstacle_session(std::shared_ptr<const Surface> surface,
                                                             std::shared_ptr<const Deformation> deformation,
                                                             const Controls& controls, EditOptions options,
                                                             Obstacles obstacles, Execution& execution);

}  // namespace stiv
