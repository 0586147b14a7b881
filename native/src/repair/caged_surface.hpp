// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/repair/contraction.hpp"

namespace stiv {

/// (N) or (m): nonzero for selected vertices or controls.
using Marks = std::vector<unsigned char>;

/// The vertices that each control moves, (m).
std::vector<std::vector<Index>> supports_of(const Deformation& deformation);

/// (m) The controls that move a marked vertex, (N).
Marks controls_moving(const Marks& vertices, const std::vector<std::vector<Index>>& supports);

/// (N) The vertices that the marked controls, (m), move.
Marks vertices_moved(const Marks& controls, const std::vector<std::vector<Index>>& supports, Index vertex_count);

/// @throws InputError if the sizes of surface, deformation, cage and p, (m, 3), do not match
void check_caged(const CagedSurface& caged, const Controls& p);

}  // namespace stiv
