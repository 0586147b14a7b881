// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/handles.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Checks the elements of a definition and returns its mesh.
/// @throws InputError: see make_laplacian
Surface checked_mesh(const HandleDefinition& definition);

/// Divides the vertices of a mesh into free ones, which are solved for, and the others: hard handles, fixed vertices,
/// and connected components without a handle.
struct HandlePartition {
  std::vector<Index> free;       ///< free vertices, ascending
  std::vector<Index> place;      ///< (n) position of a vertex in `free`, or -1
  std::vector<Index> control;    ///< (n) the control whose handle a vertex is, or -1
  std::vector<Index> component;  ///< (n) connected component of a vertex
};

HandlePartition handle_partition(const HandleDefinition& definition, const Surface& mesh);

}  // namespace stiv
