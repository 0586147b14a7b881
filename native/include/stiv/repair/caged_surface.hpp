// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "stiv/deformation/deformation.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// A surface, the deformation that moves it, and the mesh that its controls are the vertices of. Contraction smooths
/// the cage; what intersects is the surface. [P5.2, "Self-intersecting meshes", for what the paper edits by cages]
struct CagedSurface {
  std::shared_ptr<const Surface> surface;          ///< N vertices
  std::shared_ptr<const Deformation> deformation;  ///< from m controls to the N vertices
  std::shared_ptr<const Surface> cage;             ///< of the m controls
};

/// A surface whose vertices are all controls: it is its own cage.
CagedSurface without_cage(const std::shared_ptr<const Surface>& surface);

/// (m) of (N): nonzero for the controls that move a vertex which is marked. `supports` are those of all controls.
std::vector<unsigned char> controls_moving(const std::vector<unsigned char>& vertices,
                                           const std::vector<std::vector<Index>>& supports);

/// (N) of (m): nonzero for the vertices that a marked control moves.
std::vector<unsigned char> moved_by(const std::vector<unsigned char>& controls,
                                    const std::vector<std::vector<Index>>& supports, Index vertex_count);

/// The vertices that each control moves, (m).
std::vector<std::vector<Index>> supports_of(const Deformation& deformation);

/// @throws InputError if surface, deformation, cage and p, (m, 3), do not fit each other
void check_caged(const CagedSurface& caged, const Controls& p);

}  // namespace stiv
