// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/small_scenes.hpp"

namespace stiv::tests {

/// `two_sheets`, the middle of the upper one drawn down through the lower: a spike that intersects it.
inline Scene spike_through_sheet(Mobility upper = Mobility::deformable, Mobility lower = Mobility::deformable) {
  constexpr Index cells = 8;
  Scene scene;
  Triangles triangles(0, 3);
  append_sheet(scene.controls, triangles, cells, 1, Vector3(0.03, 0.02, 0.1));
  const Index first = static_cast<Index>(scene.controls.rows());
  append_sheet(scene.controls, triangles, cells, 2, Vector3::Zero());
  scene.controls((cells + 1) * (cells + 1) / 2, 2) = -0.2;
  scene.controls = scene.controls.cast<float>().cast<double>().eval();
  scene.surface = surface_of(triangles, first, static_cast<Index>(scene.controls.rows()) - first, upper, lower);
  scene.deformation = make_identity(static_cast<Index>(scene.controls.rows()));
  return scene;
}

}  // namespace stiv::tests
