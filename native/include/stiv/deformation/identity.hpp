// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/deformation.hpp"

namespace stiv {

/// q = p: one control a vertex. The metric is 1 and needs no factor.
std::shared_ptr<const Deformation> make_identity(Index vertex_count);

}  // namespace stiv
