// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/handles.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/deformation/observed.hpp"

namespace stiv {

/// q = outer(inner(p)), a linear deformation: for example a lattice followed by a subdivision.
/// @throws InputError if the number of controls of `outer` is not the number of vertices of `inner`
std::shared_ptr<const LinearDeformation> make_composition(const LinearDeformation& outer,
                                                          const LinearDeformation& inner);

/// q = outer(inner(p)) for a linear deformation, such as a subdivision, of a mesh that handles or a function of the
/// caller move.
/// @throws InputError as above
std::shared_ptr<const ComposableDeformation> make_composition(std::shared_ptr<const LinearDeformation> outer,
                                                              std::shared_ptr<const ComposableDeformation> inner);

/// q = outer(inner(p)) for a function of the caller after a linear deformation.
/// @throws InputError as above
std::shared_ptr<const SparseJacobianDeformation> make_composition(
    std::shared_ptr<const SparseJacobianDeformation> outer, std::shared_ptr<const LinearDeformation> inner);

/// q = outer(inner(p)) for a function of the caller after another one, or after a mesh moved by handles. In the latter
/// case, the metric treats x, y and z alike.
/// @throws InputError as above
std::shared_ptr<const ComposableDeformation> make_composition(std::shared_ptr<const SparseJacobianDeformation> outer,
                                                              std::shared_ptr<const ComposableDeformation> inner);

/// A component of a concatenation: a deformation, and the vertices of the whole surface that it moves, in its order.
struct DeformationComponent {
  std::shared_ptr<const Deformation> deformation;
  std::vector<Index> vertices;
};

/// Several deformations side by side on one surface. The controls are those of the components, in sequence.
/// Vertices of no component stay at `start`, (N, 3). Each component keeps its own metric.
/// @throws InputError if a vertex is out of range or in two components, or the number of a component's vertices is not
///         that of its deformation
std::shared_ptr<const Deformation> make_concatenation(std::vector<DeformationComponent> components, Positions start);

}  // namespace stiv
