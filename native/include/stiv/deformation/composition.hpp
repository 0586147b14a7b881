// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/linear.hpp"

namespace stiv {

/// q = outer(inner(p)): a linear deformation of what a linear deformation moves, as one, such as a lattice followed by
/// a subdivision. Weights are multiplied, offsets carried through.
/// @throws InputError: the outer one has another number of controls than the inner one has vertices.
std::shared_ptr<const LinearDeformation> make_composition(const LinearDeformation& outer,
                                                          const LinearDeformation& inner);

}  // namespace stiv
