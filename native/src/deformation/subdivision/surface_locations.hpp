// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "deformation/subdivision/subdivided_vertices.hpp"

namespace stiv {

/// A point of the limit surface: a ptex face of OpenSubdiv and coordinates in [0, 1] within it; s + t <= 1 in a
/// triangle of Loop's scheme.
struct SurfaceLocation {
  Index ptex_face = -1;  ///< -1: on no face (a loose vertex, or on a loose edge)
  double s = 0, t = 0;
};

/// Where each vertex of the subdivided cage lies. Of the faces that share a vertex, the first decides, as in Blender.
std::vector<SurfaceLocation> surface_locations(const Cage& cage, const SubdividedVertices& vertices);

}  // namespace stiv
