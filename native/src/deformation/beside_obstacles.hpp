// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "stiv/deformation/deformation.hpp"

namespace stiv {

/// The same deformation, followed by vertices that stay at `obstacles`, (k, 3).
std::shared_ptr<const Deformation> make_beside_obstacles(std::shared_ptr<const Deformation> deformation,
                                                         Positions obstacles);

}  // namespace stiv
