// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/deformation/deformation.hpp"
#include "stiv/editing/options.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// @throws InputError if surface and deformation, or the options and the number of controls, do not fit together
void check_fit(const Surface& surface, const Deformation& deformation);
void check_options(const EditOptions& options, Index control_count);

/// "object "X", control 7": the object is the first that the control moves.
std::string describe_control(const Surface& surface, const Deformation& deformation, Index control);

using StartIntersections = StaticPairs;

/// What to say when the start intersects: how often, the first pairs by object and face, and the ways out.
std::string describe(const Surface& surface, const StartIntersections& found);

}  // namespace stiv
