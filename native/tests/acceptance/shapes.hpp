// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "stiv/surface.hpp"

namespace stiv {

/// A surface assembled body by body.
struct Assembly {
  SurfaceDefinition definition;
  Positions q = Positions(0, 3);

  /// Appends a closed grid of rows x columns quads; `point(u, v)` gives the place for angles u, v in [0, 2 pi).
  template <class Point>
  void add_torus_grid(Index rows, Index columns, Mobility mobility, const Point& point) {
    const Index base = begin_body(rows * columns, mobility);
    const auto vertex = [&](Index i, Index j) { return base + (i % rows) * columns + j % columns; };
    for (Index i = 0; i < rows; ++i) {
      for (Index j = 0; j < columns; ++j) {
        q.row(vertex(i, j)) = point(2 * std::numbers::pi * i / rows, 2 * std::numbers::pi * j / columns);
        add_triangle(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
        add_triangle(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
      }
    }
  }

  /// Triangles of random corners in the unit cube, `size` wide.
  void add_soup(Index triangles, double size, Mobility mobility, std::mt19937& random) {
    std::uniform_real_distribution<double> place(0, 1), offset(-size, size);
    const Index base = begin_body(3 * triangles, mobility);
    for (Index k = 0; k < triangles; ++k) {
      const Vector3 centre(place(random), place(random), place(random));
      for (Index corner = 0; corner < 3; ++corner)
        q.row(base + 3 * k + corner) = centre + Vector3(offset(random), offset(random), offset(random));
      add_triangle(base + 3 * k, base + 3 * k + 1, base + 3 * k + 2);
    }
  }

  std::shared_ptr<const Surface> surface() const { return std::make_shared<const Surface>(definition); }

  Index begin_body(Index vertices, Mobility mobility) {
    const auto body = static_cast<Index>(definition.bodies.size());
    definition.bodies.push_back({"body " + std::to_string(body), mobility});
    const Index base = definition.vertex_count;
    definition.vertex_count += vertices;
    definition.vertex_body.resize(static_cast<std::size_t>(definition.vertex_count), body);
    q.conservativeResize(definition.vertex_count, 3);
    return base;
  }

  void add_triangle(Index a, Index b, Index c) {
    definition.triangles.conservativeResize(definition.triangles.rows() + 1, 3);
    definition.triangles.bottomRows(1) << a, b, c;
  }
};

/// Two rings linked as in a chain, free of intersections; `shift` moves the second along x.
inline Assembly linked_tori(Index rows, Index columns, double shift) {
  Assembly scene;
  scene.add_torus_grid(rows, columns, Mobility::deformable, [](double u, double v) {
    const double ring = 2 + 0.5 * std::cos(v);
    return Vector3(ring * std::cos(u), ring * std::sin(u), 0.5 * std::sin(v));
  });
  scene.add_torus_grid(rows, columns, Mobility::deformable, [shift](double u, double v) {
    const double ring = 2 + 0.5 * std::cos(v);
    return Vector3(2 + shift + ring * std::cos(u), 0.5 * std::sin(v), ring * std::sin(u));
  });
  return scene;
}

}  // namespace stiv
