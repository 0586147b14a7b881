// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "stiv/surface.hpp"

namespace stiv {

/// A body that bounds a volume: every edge of one of its triangles belongs to exactly one more, which runs along it the
/// other way. It may have several connected components: an inner one that faces inward is a cavity.
struct ClosedBody {
  std::vector<Index> triangles;             ///< ascending
  std::vector<std::array<Index, 2>> edges;  ///< of the triangles, each once, smaller vertex first; sorted
  std::vector<Index> seeds;                 ///< a vertex of each component
  std::vector<std::array<Index, 2>>
      walk;  ///< edges (from, to) that lead from the seeds to all other vertices, in order
};

/// Nothing if the body is not closed, has no triangles, or has one with repeated corners.
std::optional<ClosedBody> closed_body(const Surface& surface, Index body);

/// How often the triangles wind around a point off them, 1 inside of a body that faces outward: their solid angles
/// [van Oosterom, Strackee 1983] over a full one. Not a whole number within rounding where the point lies on them.
double winding_number(const Surface& surface, const ClosedBody& body, const Positions& q, const Vector3& point);

}  // namespace stiv
