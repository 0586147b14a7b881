// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "stiv/surface.hpp"

namespace stiv {

/// A surface and a step of it.
struct MovingScene {
  std::shared_ptr<const Surface> surface;
  Positions start, end;
};

/// A height field of `size` x `size` vertices, appended as a separate body.
inline void add_sheet(SurfaceDefinition& definition, std::vector<Vector3>& points, Index size, double height,
                      double roughness, std::mt19937& random) {
  const Index base = definition.vertex_count;
  const auto body = static_cast<Index>(definition.bodies.size());
  definition.bodies.push_back({"sheet " + std::to_string(body), Mobility::deformable});
  std::uniform_real_distribution<double> noise(-roughness, roughness);
  for (Index i = 0; i < size; ++i)
    for (Index j = 0; j < size; ++j) points.emplace_back(i / double(size), j / double(size), height + noise(random));
  const Index face = static_cast<Index>(definition.triangles.rows());
  definition.triangles.conservativeResize(face + 2 * (size - 1) * (size - 1), 3);
  Index row = face;
  for (Index i = 0; i + 1 < size; ++i)
    for (Index j = 0; j + 1 < size; ++j) {
      const Index a = base + i * size + j, b = a + 1, c = a + size, d = c + 1;
      definition.triangles.row(row++) << a, b, d;
      definition.triangles.row(row++) << a, d, c;
    }
  definition.vertex_count += size * size;
  definition.vertex_body.resize(static_cast<std::size_t>(definition.vertex_count), body);
}

/// Stacked sheets that are stirred, so that they collide with each other and with themselves.
inline MovingScene stirred_sheets(Index size, int sheets, double stir, unsigned seed) {
  std::mt19937 random(seed);
  SurfaceDefinition definition;
  definition.triangles.resize(0, 3);
  std::vector<Vector3> points;
  for (int k = 0; k < sheets; ++k) add_sheet(definition, points, size, 0.1 * k, 0.02, random);
  MovingScene scene;
  scene.start.resize(definition.vertex_count, 3);
  for (Index k = 0; k < definition.vertex_count; ++k) scene.start.row(k) = points[static_cast<std::size_t>(k)];
  scene.end = scene.start;
  std::uniform_real_distribution<double> noise(-stir, stir);
  for (Index k = 0; k < definition.vertex_count; ++k)
    for (Index axis = 0; axis < 3; ++axis) scene.end(k, axis) += noise(random);
  scene.surface = std::make_shared<const Surface>(std::move(definition));
  return scene;
}

/// The same sheets, each carried along by its own displacement; a zero one leaves its sheet at rest.
inline MovingScene carried_sheets(Index size, const std::vector<Vector3>& displacements, double stir, unsigned seed) {
  MovingScene scene = stirred_sheets(size, static_cast<int>(displacements.size()), stir, seed);
  for (std::size_t sheet = 0; sheet < displacements.size(); ++sheet) {
    const Index first = static_cast<Index>(sheet) * size * size;
    if (displacements[sheet].isZero(0))
      scene.end.middleRows(first, size * size) = scene.start.middleRows(first, size * size);
    else
      scene.end.middleRows(first, size * size).rowwise() += displacements[sheet].transpose();
  }
  return scene;
}

}  // namespace stiv
