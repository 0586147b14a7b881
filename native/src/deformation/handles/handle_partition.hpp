// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/handles.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The mesh of a definition.
/// @throws InputError: see make_laplacian
Surface checked_mesh(const HandleDefinition& definition);

/// Which vertices of a mesh are solved for. The others are held: by a hard handle, because they are fixed, or because
/// nothing of their part of the mesh is a handle.
struct HandlePartition {
  std::vector<Index> free;     ///< vertices that are solved for, ascending
  std::vector<Index> place;    ///< (n) place of a vertex among them, or -1
  std::vector<Index> control;  ///< (n) the control whose handle a vertex is, or -1
  std::vector<Index> part;     ///< (n) which connected part of the mesh it belongs to
};

HandlePartition handle_partition(const HandleDefinition& definition, const Surface& mesh);

}  // namespace stiv
