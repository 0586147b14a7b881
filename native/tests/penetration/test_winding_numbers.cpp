// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/winding_numbers.hpp"

#include <doctest/doctest.h>

#include "penetration/boxes.hpp"
#include "penetration/placed_pair.hpp"
#include "penetration/solid_angles.hpp"

using namespace stiv;

namespace {

/// A nudge that is large enough for solid angles, and small against whole numbers.
const Vector3 visible_nudge(0x1p-7, 0x1p-14, 0x1p-21);

}  // namespace

TEST_CASE("winding numbers along a ray are those of solid angles, and those along edges too") {
  std::mt19937 random(1);
  for (const double scale : {1e-7, 1.0, 1e7}) {
    Assembly scene = linked_tori(12, 9, -1.9);
    scene.q *= scale;
    const PlacedPair pair(scene);
    const Triangles closed = scene.definition.triangles.bottomRows(pair.second.triangle_count());
    const std::vector<int> along_edges = winding_numbers(pair.crossings(), 0);
    int inside = 0;
    for (Index vertex = 0; vertex < static_cast<Index>(along_edges.size()); ++vertex) {
      const Vector3& point = pair.first.point(vertex);
      const double expected = winding_by_solid_angles(closed, scene.q, point);
      REQUIRE(std::abs(expected - std::round(expected)) < 1e-6);
      CHECK(winding_number(pair.second, point, 1) == static_cast<int>(std::round(expected)));
      CHECK(along_edges[static_cast<std::size_t>(vertex)] == static_cast<int>(std::round(expected)));
      inside += std::abs(expected) > 0.5;  // these tori face inward
    }
    CHECK(inside > 3);
  }
}

TEST_CASE("points on faces, edges and corners are on the side to which they are nudged") {
  Assembly scene;
  add_box(scene, Eigen::Affine3d::Identity());
  const auto surface = scene.surface();
  const BodyMesh mesh = whole_body(*surface, 0);
  const PlacedBody box(mesh, scene.q);
  int inside = 0;
  for (int nudge : {1, -1})
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y)
        for (int z = -3; z <= 3; ++z) {
          const Vector3 point(x, y, z), nudged = point + nudge * visible_nudge;
          const double expected = winding_by_solid_angles(surface->triangles(), scene.q, nudged);
          REQUIRE(winding_number(box, point, nudge) == static_cast<int>(std::round(expected)));
          inside += winding_number(box, point, nudge);
        }
  CHECK(inside == 2 * 4 * 4 * 4);  // of 5 x 5 x 5 points on and in the box one layer is outside along each axis
}

TEST_CASE("a flat body, a body in the plane of the ray's start and one in itself twice are counted") {
  Assembly scene;
  add_box(scene, Eigen::Affine3d(Eigen::Scaling(0.0, 1.0, 1.0)));
  const BodyMesh flat = whole_body(*scene.surface(), 0);
  CHECK(winding_number(PlacedBody(flat, scene.q), Vector3(0, 1, 1), 1) == 0);
  Assembly twice;
  auto corners = box_corners(Eigen::Affine3d::Identity());
  auto faces = box_faces;
  for (const Vector3& corner : box_corners(Eigen::Affine3d(Eigen::Translation3d(1, 0, 0)))) corners.push_back(corner);
  for (auto face : box_faces) {
    for (Index& vertex : face) vertex += 8;
    faces.push_back(face);
  }
  add_body(twice, corners, faces);
  const BodyMesh mesh = whole_body(*twice.surface(), 0);
  CHECK(winding_number(PlacedBody(mesh, twice.q), Vector3(0.5, 0.3, 0.1), 1) == 2);
}
