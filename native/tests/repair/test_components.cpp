// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/components.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

#include "repair/tangled_scenes.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

/// A triangle and two tetrahedra, one body each; each test specifies which of their triangles intersect.
std::shared_ptr<const Surface> three_bodies() {
  SurfaceDefinition definition;
  definition.vertex_count = 11;
  definition.triangles.resize(9, 3);
  definition.triangles << 0, 1, 2, 3, 4, 5, 3, 6, 4, 4, 6, 5, 5, 6, 3, 7, 8, 9, 7, 10, 8, 8, 10, 9, 9, 10, 7;
  definition.vertex_body = {0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2};
  definition.bodies = {{"leaf"}, {"first"}, {"second"}};
  return std::make_shared<Surface>(definition);
}

}  // namespace

TEST_CASE("bodies in all pairs, closed ones first") {
  const auto surface = three_bodies();
  StaticPairs pairs;
  pairs.faces = {{0, 1}, {0, 2}};
  auto vertices = vertices_of_pairs(*surface, pairs);
  CHECK(vertices.front() == std::vector<Index>{0, 1, 2, 3, 4, 5});
  CHECK(bodies_in_pairs(*surface, vertices) == std::vector<Index>{0, 1});
  CHECK(bodies_in_all_pairs(*surface, vertices) == std::vector<Index>{1, 0});
  pairs.faces = {{0, 1}, {0, 5}};
  vertices = vertices_of_pairs(*surface, pairs);
  CHECK(bodies_in_all_pairs(*surface, vertices) == std::vector<Index>{0});
}

TEST_CASE("components are sorted by size and contain movable vertices only") {
  const auto surface = three_bodies();
  StaticPairs pairs;
  pairs.faces = {{0, 5}};
  Marks movable(11, 1);
  movable[8] = 0;
  const std::vector<Marks> components = components_in_pairs(*surface, vertices_of_pairs(*surface, pairs), movable);
  REQUIRE(components.size() == 2);
  CHECK(components[0] == Marks{1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0});
  CHECK(components[1] == Marks{0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 1});
}

TEST_CASE("a region contains vertices up to the given number of edges away") {
  Scene scene;
  Triangles triangles(0, 3);
  const Index cells = 9, side = cells + 1;
  append_sheet(scene.controls, triangles, cells, 1, Vector3::Zero());
  SurfaceDefinition definition;
  definition.vertex_count = side * side;
  definition.triangles = triangles;
  const Surface surface(definition);
  const Index middle = 4 * side + 5;
  for (int rings = 0; rings < 4; ++rings) {
    const Marks region = region_around(surface, {{middle}}, rings, Marks(static_cast<std::size_t>(side * side), 1));
    for (Index vertex = 0; vertex < side * side; ++vertex) {
      // Diagonals run from low to high indices: steps of (1, 0), (0, 1) and (1, 1), and back.
      const Index i = vertex / side - middle / side, j = vertex % side - middle % side;
      const Index distance = i * j > 0 ? std::max(std::abs(i), std::abs(j)) : std::abs(i) + std::abs(j);
      CHECK((region[static_cast<std::size_t>(vertex)] != 0) == (distance <= rings));
    }
  }
}
