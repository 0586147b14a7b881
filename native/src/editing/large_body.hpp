// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/surface.hpp"

namespace stiv {

/// Mean length of the edges of bodies that may move and are so large that they get their own frames in a search; 0 if
/// there are none. Searching one takes long, and finds very many contacts where it moves by many edges into
/// something.
/// @param q positions of at least all vertices that may move
double mean_edge_of_large_bodies(const Surface& surface, const Positions& q);

}  // namespace stiv
