// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "acceptance/shapes.hpp"
#include "penetration/body_mesh.hpp"
#include "penetration/crossings.hpp"
#include "stiv/acceptance/intersections.hpp"

namespace stiv {

/// All triangles of a body.
inline BodyMesh whole_body(const Surface& surface, Index body) {
  std::vector<Index> triangles;
  for (Index k = 0; k < static_cast<Index>(surface.triangles().rows()); ++k)
    if (surface.body_of(surface.triangles()(k, 0)) == body) triangles.push_back(k);
  return body_mesh(surface, std::move(triangles));
}

/// The first two bodies of an assembly with the intersecting pairs of their triangles.
struct PlacedPair {
  explicit PlacedPair(const Assembly& assembly)
      : surface(assembly.surface()),
        meshes{whole_body(*surface, 0), whole_body(*surface, 1)},
        first(meshes[0], assembly.q),
        second(meshes[1], assembly.q) {
    const Index split = first.triangle_count();
    Execution execution(1);
    for (const auto& [a, b] : IntersectionTest(surface).find(assembly.q, execution))
      if (a < split && b >= split) meeting.emplace_back(a, b - split);
  }
  PlacedPair(const PlacedPair&) = delete;
  PlacedPair& operator=(const PlacedPair&) = delete;

  Crossings crossings(int perturbation = 1) const { return Crossings(first, second, meeting, perturbation); }

  std::shared_ptr<const Surface> surface;
  std::array<BodyMesh, 2> meshes;
  PlacedBody first, second;
  IndexPairs meeting;
};

}  // namespace stiv
