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

TEST_CASE("a body's mesh has its triangles alone, with the corners that the surface has") {
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

TEST_CASE("the walk reaches every vertex once, from a seed for each component") {
  Assembly assembly;
  add_sheet(assembly, 4, unit);
  assembly.definition.vertex_count += 25;  // a second piece of the same body
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
