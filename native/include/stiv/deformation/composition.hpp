// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/handles.hpp"
#include "stiv/deformation/linear.hpp"

namespace stiv {

/// q = outer(inner(p)): a linear deformation of what a linear deformation moves, as one, such as a lattice followed by
/// a subdivision. Weights are multiplied, offsets carried through.
/// @throws InputError: the outer one has another number of controls than the inner one has vertices.
std::shared_ptr<const LinearDeformation> make_composition(const LinearDeformation& outer,
                                                          const LinearDeformation& inner);

/// q = outer(inner(p)) for a mesh that is moved by handles, such as a cage, and what follows it, such as a subdivision.
/// @throws InputError as above
std::shared_ptr<const HandleDeformation> make_composition(std::shared_ptr<const LinearDeformation> outer,
                                                          std::shared_ptr<const HandleDeformation> inner);

}  // namespace stiv
