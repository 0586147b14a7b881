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

/// What intersects at the start.
struct StartIntersections {
  IndexPairs faces;           ///< pairs of triangles
  IndexPairs loose_edges;     ///< (loose edge, triangle)
  IndexPairs loose_vertices;  ///< (vertex of no edge, triangle)

  bool empty() const { return faces.empty() && loose_edges.empty() && loose_vertices.empty(); }
};

/// What to say when the start intersects: how often, the first pairs by object and face, and the ways out.
std::string describe(const Surface& surface, const StartIntersections& found);

}  // namespace stiv
