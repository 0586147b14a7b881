// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/deformation/deformation.hpp"
#include "stiv/editing/options.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// @throws InputError if surface and deformation, or the options and the number of controls, do not fit together
void check_fit(const Surface& surface, const Deformation& deformation, Index obstacle_vertices = 0);
void check_options(const EditOptions& options, Index control_count);
void check_overlapping(const Surface& surface, const std::vector<std::pair<Index, Index>>& overlapping);
void check_touching(const Surface& surface, const std::vector<Index>& touching);

/// "object "X", control 7": of the first vertex that the control moves.
std::string describe_control(const Surface& surface, const Deformation& deformation, Index control);

/// The message for a start that intersects: the number of pairs, the first ones by object and face, and the ways out.
/// @param name_face names a triangle
std::string describe(const Surface& surface, const StaticPairs& found,
                     const std::function<std::string(Index)>& name_face);
std::string describe(const Surface& surface, const StaticPairs& found);

}  // namespace stiv
