// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "stiv/deformation/combination.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/deformation/placement.hpp"
#include "stiv/surface.hpp"

namespace stiv::tests {

/// A surface with a deformation and its current controls.
struct Scene {
  std::shared_ptr<const Surface> surface;
  std::shared_ptr<const Deformation> deformation;
  Controls controls;
};

/// Appends a flat n x n grid of the given size, centered at `centre`, to positions and triangles.
inline void append_sheet(Positions& q, Triangles& triangles, Index cells, double size, const Vector3& centre) {
  const Index first = static_cast<Index>(q.rows()), side = cells + 1;
  q.conservativeResize(first + side * side, 3);
  for (Index i = 0; i < side; ++i)
    for (Index j = 0; j < side; ++j)
      q.row(first + i * side + j) << centre[0] + size * (double(i) / cells - 0.5),
          centre[1] + size * (double(j) / cells - 0.5), centre[2];
  const Index first_face = static_cast<Index>(triangles.rows());
  triangles.conservativeResize(first_face + 2 * cells * cells, 3);
  for (Index i = 0; i < cells; ++i)
    for (Index j = 0; j < cells; ++j) {
      const Index a = first + i * side + j, b = a + side, c = b + 1, d = a + 1;
      triangles.row(first_face + 2 * (i * cells + j)) << a, b, c;
      triangles.row(first_face + 2 * (i * cells + j) + 1) << a, c, d;
    }
}

inline std::shared_ptr<const Surface> surface_of(const Triangles& triangles, Index first_count, Index second_count,
                                                 Mobility first, Mobility second) {
  SurfaceDefinition definition;
  definition.vertex_count = first_count + second_count;
  definition.triangles = triangles;
  definition.vertex_body.assign(first_count, 0);
  definition.vertex_body.insert(definition.vertex_body.end(), second_count, 1);
  definition.bodies = {{"mover", first}, {"wall", second}};
  return std::make_shared<Surface>(definition);
}

/// Two deformable sheets, the smaller 0.5 above the larger; every vertex is a control.
inline Scene two_sheets(Index cells = 6) {
  Scene scene;
  Triangles triangles(0, 3);
  append_sheet(scene.controls, triangles, cells, 1, Vector3(0.03, 0.02, 0.5));
  const Index first = static_cast<Index>(scene.controls.rows());
  append_sheet(scene.controls, triangles, cells, 2, Vector3::Zero());
  const Index count = static_cast<Index>(scene.controls.rows());
  scene.surface = surface_of(triangles, first, count - first, Mobility::deformable, Mobility::deformable);
  scene.deformation = make_identity(count);
  return scene;
}

/// A rigid plate 0.5 above a fixed one; controls (2, 3): center and rotation vector.
inline Scene plate_over_wall(Index cells = 3) {
  Scene scene;
  Positions q(0, 3);
  Triangles triangles(0, 3);
  append_sheet(q, triangles, cells, 1, Vector3(0.03, 0.02, 0.5));
  const Index first = static_cast<Index>(q.rows());
  append_sheet(q, triangles, 8, 6, Vector3::Zero());
  scene.surface = surface_of(triangles, first, static_cast<Index>(q.rows()) - first, Mobility::rigid, Mobility::fixed);
  std::vector<Index> vertices;
  for (Index vertex = 0; vertex < first; ++vertex) vertices.push_back(vertex);
  const Positions rest = q.topRows(first);
  scene.deformation = make_concatenation({{make_rigid(rest), vertices}}, q);
  scene.controls = rigid_rest_controls(rest);
  return scene;
}

}  // namespace stiv::tests
