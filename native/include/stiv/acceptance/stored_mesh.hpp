// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "stiv/deformation/handles.hpp"

namespace stiv {

/// A mesh moved by handles whose vertices, not whose controls, are stored: its surface is what is read back after
/// storing every vertex in single precision in `frame`, (4, 4), local to world. A linear deformation that follows (a
/// subdivision of a cage) then acts on the stored cage, as it will when the cage is read again. The response is that of
/// `mesh`: rounding has no derivative. [docs/mathematics.md, "Values as stored"]
/// @throws InputError as as_stored does
std::shared_ptr<const HandleDeformation> make_stored_mesh(std::shared_ptr<const HandleDeformation> mesh,
                                                          const Eigen::Matrix4d& frame);

}  // namespace stiv
