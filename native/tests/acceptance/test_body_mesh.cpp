// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/body_mesh.hpp"

#include <doctest/doctest.h>

#include <set>

#include "boxes.hpp"

using namespace stiv;

namespace {

const Eigen::Affine3d unit = Eigen::Affine3d::Identity();

bool is_closed(const Assembly& assembly, Index body = 0) { return body_mesh(*assembly.surface(), body).closed; }

}  // namespace

TEST_CASE("a body's mesh has its triangles alone, with the corners that the surface has") {
  Assembly assembly;
  add_sheet(assembly, 3, unit);
  add_box(assembly, unit);
  const auto surface = assembly.surface();
  const BodyMesh mesh = body_mesh(*surface, 1);
  REQUIRE(mesh.triangles.size() == 12);
  CHECK(mesh.vertices.size() == 8);
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    for (std::size_t corner = 0; corner < 3; ++corner)
      CHECK(mesh.vertices[static_cast<std::size_t>(mesh.corners[k][corner])] ==
            surface->triangles()(mesh.triangles[k], static_cast<Index>(corner)));
}

TEST_CASE("a box is closed, a sheet is not, nor is a box without a triangle or with one turned round") {
  Assembly box, sheet;
  add_box(box, unit);
  add_sheet(sheet, 2, unit);
  CHECK(is_closed(box));
  CHECK_FALSE(is_closed(sheet));
  Assembly turned = box;
  turned.definition.triangles.row(4).reverseInPlace();
  CHECK_FALSE(is_closed(turned));
  box.definition.triangles.conservativeResize(11, 3);
  CHECK_FALSE(is_closed(box));
}

TEST_CASE("two boxes that share an edge are closed, and triangles with repeated corners open nothing") {
  auto corners = box_corners(unit);
  auto faces = box_faces;
  for (const Index k : {1, 3, 4, 5, 6, 7}) corners.push_back(corners[static_cast<std::size_t>(k)] - Vector3(4, 4, 0));
  for (const auto& face : box_faces) {  // the other box has its corners 6, 7 where this one has 0, 1
    const std::array<Index, 8> other{8, 9, 10, 11, 12, 13, 0, 1};
    std::vector<Index>& shared = faces.emplace_back();
    for (const Index k : face) shared.push_back(other[static_cast<std::size_t>(k)]);
  }
  Assembly both;
  add_body(both, corners, faces);
  CHECK(is_closed(both));
  both.add_triangle(0, 0, 5);
  CHECK(is_closed(both));
}

TEST_CASE("the walk reaches every vertex once, from a seed for each component") {
  Assembly assembly;
  add_sheet(assembly, 4, unit);
  assembly.definition.vertex_count += 25;  // a second piece of the same body
  assembly.definition.vertex_body.resize(50, 0);
  const Triangles piece = assembly.definition.triangles;
  assembly.definition.triangles.conservativeResize(2 * piece.rows(), 3);
  assembly.definition.triangles.bottomRows(piece.rows()) = piece.array() + 25;
  const BodyMesh mesh = body_mesh(*assembly.surface(), 0);
  CHECK(mesh.seeds.size() == 2);
  std::set<Index> reached(mesh.seeds.begin(), mesh.seeds.end());
  for (const auto& [from, to] : mesh.walk) {
    CHECK(reached.count(from) == 1);
    CHECK(reached.insert(to).second);
  }
  CHECK(reached.size() == 50);
}
