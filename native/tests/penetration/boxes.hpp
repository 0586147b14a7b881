// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <vector>

#include "acceptance/shapes.hpp"

// Boxes and other polyhedra, and the clipping of polygons by planes.
namespace stiv {

using Polygon = std::vector<Vector3>;

/// A polyhedron from loops of vertices, counter-clockwise seen from outside, triangulated as fans.
inline void add_body(Assembly& assembly, const std::vector<Vector3>& corners,
                     const std::vector<std::vector<Index>>& faces) {
  const Index base = assembly.begin_body(static_cast<Index>(corners.size()), Mobility::deformable);
  for (std::size_t k = 0; k < corners.size(); ++k) assembly.q.row(base + static_cast<Index>(k)) = corners[k];
  for (const auto& face : faces)
    for (std::size_t k = 2; k < face.size(); ++k)
      assembly.add_triangle(base + face[0], base + face[k - 1], base + face[k]);
}

inline const std::vector<std::vector<Index>> box_faces{{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                                       {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};

/// A transformed cube of side 4 around the origin.
inline std::vector<Vector3> box_corners(const Eigen::Affine3d& frame) {
  std::vector<Vector3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back(frame * Vector3((k & 4) - 2, 2 * (k & 2) - 2, 4 * (k & 1) - 2));
  return corners;
}

inline void add_box(Assembly& assembly, const Eigen::Affine3d& frame) {
  add_body(assembly, box_corners(frame), box_faces);
}

/// A transformed flat sheet of cells x cells quads, of side 2 around the origin in the plane z = 0.
inline void add_sheet(Assembly& assembly, Index cells, const Eigen::Affine3d& frame) {
  const Index side = cells + 1, base = assembly.begin_body(side * side, Mobility::deformable);
  for (Index i = 0; i < side; ++i)
    for (Index j = 0; j < side; ++j)
      assembly.q.row(base + i * side + j) = frame * Vector3(2.0 * i / cells - 1, 2.0 * j / cells - 1, 0);
  for (Index i = 0; i < cells; ++i)
    for (Index j = 0; j < cells; ++j) {
      const Index a = base + i * side + j;
      assembly.add_triangle(a, a + side, a + side + 1);
      assembly.add_triangle(a, a + side + 1, a + 1);
    }
}

inline Eigen::Affine3d random_frame(std::mt19937& random, double reach) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random));
  return Eigen::Translation3d(reach * Vector3(normal(random), normal(random), normal(random))) * turn.normalized();
}

/// Faces of a box as polygons.
inline std::vector<Polygon> polygons(const std::vector<Vector3>& corners) {
  std::vector<Polygon> faces;
  for (const auto& face : box_faces) {
    Polygon& polygon = faces.emplace_back();
    for (const Index k : face) polygon.push_back(corners[static_cast<std::size_t>(k)]);
  }
  return faces;
}

/// The part of a polygon behind the plane of another.
inline Polygon behind(const Polygon& polygon, const Polygon& plane) {
  const Vector3 normal = (plane[1] - plane[0]).cross(plane[2] - plane[0]);
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double da = normal.dot(a - plane[0]), db = normal.dot(b - plane[0]);
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept.push_back(a + da / (da - db) * (b - a));
  }
  return kept;
}

/// The intersection of a polygon and a convex body.
inline Polygon inside(Polygon polygon, const std::vector<Polygon>& faces) {
  for (const Polygon& face : faces)
    if (polygon.size() > 2) polygon = behind(polygon, face);
  return polygon;
}

inline double area_of(const Polygon& polygon) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 2; k < polygon.size(); ++k) sum += (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]);
  return sum.norm() / 2;
}

}  // namespace stiv
