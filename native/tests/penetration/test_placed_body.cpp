// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/placed_body.hpp"

#include <doctest/doctest.h>

#include "penetration/boxes.hpp"
#include "penetration/placed_pair.hpp"

using namespace stiv;

TEST_CASE("a placed box has its corners, areas along its normals outward, and its volume with the sign of its facing") {
  std::mt19937 random(1);
  for (const double scale : {1e-7, 1.0, 1e7}) {
    Assembly scene;
    add_sheet(scene, 2, Eigen::Affine3d::Identity());
    add_box(scene, random_frame(random, 3) * Eigen::Scaling(1.0, 2.0, 0.5));
    scene.q *= scale;
    const BodyMesh mesh = whole_body(*scene.surface(), 1);
    const PlacedBody box(mesh, scene.q);
    REQUIRE(box.triangle_count() == 12);
    const Vector3 middle = scene.q.bottomRows(8).colwise().mean().transpose();
    for (Index k = 0; k < 12; ++k) CHECK(box.area_vector(k).dot(box.triangle(k)[0] - middle) > 0);
    for (Index vertex = 0; vertex < 8; ++vertex) {
      CHECK(box.point(vertex) == scene.q.row(9 + vertex).transpose());
      CHECK(box.box().contains(box.point(vertex)));
    }
    CHECK(box.signed_volume() / (scale * scale * scale) == doctest::Approx(64));
    scene.definition.triangles.bottomRows(12).rowwise().reverseInPlace();
    const BodyMesh turned = whole_body(*scene.surface(), 1);
    CHECK(PlacedBody(turned, scene.q).signed_volume() / (scale * scale * scale) == doctest::Approx(-64));
  }
}
