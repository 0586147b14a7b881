// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/body_mesh.hpp"

#include <doctest/doctest.h>

#include <set>

#include "penetration/boxes.hpp"
#include "penetration/placed_pair.hpp"

using namespace stiv;

namespace {

const Eigen::Affine3d unit = Eigen::Affine3d::Identity();

}  // namespace

TEST_CASE("a body's mesh has its triangles only, with the surface's corners") {
  Assembly assembly;
  add_sheet(assembly, 3, unit);
  add_box(assembly, unit);
  const auto surface = assembly.surface();
  const BodyMesh mesh = whole_body(*surface, 1);
  REQUIRE(mesh.triangles.size() == 12);
  CHECK(mesh.vertices.size() == 8);
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    for (std::size_t corner = 0; corner < 3; ++corner)
      CHECK(mesh.vertices[static_cast<std::size_t>(mesh.corners[k][corner])] ==
            surface->triangles()(mesh.triangles[k], static_cast<Index>(corner)));
}

TEST_CASE("the spanning forest reaches every vertex once, from one seed for each component") {
  Assembly assembly;
  add_sheet(assembly, 4, unit);
  assembly.definition.vertex_count += 25;  // a second component of the same body
  assembly.definition.vertex_body.resize(50, 0);
  const Triangles piece = assembly.definition.triangles;
  assembly.definition.triangles.conservativeResize(2 * piece.rows(), 3);
  assembly.definition.triangles.bottomRows(piece.rows()) = piece.array() + 25;
  const BodyMesh mesh = whole_body(*assembly.surface(), 0);
  CHECK(mesh.seeds.size() == 2);
  std::set<Index> reached(mesh.seeds.begin(), mesh.seeds.end());
  for (const auto& [from, to] : mesh.walk) {
    CHECK(reached.count(from) == 1);
    CHECK(reached.insert(to).second);
  }
  CHECK(reached.size() == 50);
}

TEST_CASE("a placed box: corners, outward area vectors, and a volume with the sign of its orientation") {
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
