// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "stiv/error.hpp"
#include "stiv/surface.hpp"

using namespace stiv;

namespace {

SurfaceDefinition two_triangles() {
  SurfaceDefinition definition;
  definition.vertex_count = 6;
  definition.triangles.resize(2, 3);
  definition.triangles << 0, 1, 2, 3, 4, 5;
  definition.vertex_body = {0, 0, 0, 1, 1, 1};
  definition.bodies = {{"left", Mobility::deformable}, {"right", Mobility::fixed}};
  return definition;
}

}  // namespace

TEST_CASE("surface: edges are unique and neighbours ascend") {
  SurfaceDefinition definition;
  definition.vertex_count = 5;
  definition.triangles.resize(2, 3);
  definition.triangles << 2, 1, 0, 1, 2, 3;
  definition.loose_edges.resize(1, 2);
  definition.loose_edges << 4, 3;
  const Surface surface(definition);
  Edges expected(6, 2);
  expected << 0, 1, 0, 2, 1, 2, 1, 3, 2, 3, 3, 4;
  CHECK(surface.edges() == expected);
  CHECK(std::vector<Index>(surface.neighbours_begin(3), surface.neighbours_end(3)) == std::vector<Index>{1, 2, 4});
}

TEST_CASE("surface: which bodies meet") {
  SurfaceDefinition definition = two_triangles();
  definition.bodies.push_back({"fixed too", Mobility::fixed});
  definition.bodies.push_back({"rigid", Mobility::rigid});
  definition.ignored = {{3, 0}};
  const Surface surface(definition);
  CHECK(surface.bodies_meet(0, 0));
  CHECK_FALSE(surface.bodies_meet(1, 1));
  CHECK_FALSE(surface.bodies_meet(1, 2));
  CHECK_FALSE(surface.bodies_meet(3, 3));
  CHECK(surface.bodies_meet(1, 3));
  CHECK_FALSE(surface.bodies_meet(0, 3));
}

TEST_CASE("surface: vertices of one flip face are found, whatever other faces they have") {
  SurfaceDefinition definition = two_triangles();
  definition.flip_faces = {{0, 1, 2}, {2, 1, 5, 3}};
  const Surface surface(definition);
  CHECK(surface.in_one_flip_face(std::array<Index, 3>{1, 2, 0}));
  CHECK(surface.in_one_flip_face(std::array<Index, 4>{5, 3, 1, 2}));
  CHECK_FALSE(surface.in_one_flip_face(std::array<Index, 3>{0, 1, 5}));
  CHECK_FALSE(surface.in_one_flip_face(std::array<Index, 2>{4, 4}));
  definition.flip_faces = {{0, 6}};
  CHECK_THROWS_WITH_AS(Surface{definition}, doctest::Contains("flip face 0"), InputError);
}

TEST_CASE("surface: areas add up to the total area") {
  const Surface surface(two_triangles());
  Positions q(6, 3);
  q << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 1, 0, 2, 1;
  CHECK(surface.vertex_areas(q).sum() == doctest::Approx(0.5 + 2.0));
  CHECK(surface.vertex_areas(q)[4] == doctest::Approx(2.0 / 3));
}

TEST_CASE("surface: bad input is named") {
  SurfaceDefinition out_of_range = two_triangles();
  out_of_range.triangles(1, 2) = 6;
  CHECK_THROWS_WITH_AS(Surface{out_of_range}, doctest::Contains("face 1: vertex index 6"), InputError);
  SurfaceDefinition across = two_triangles();
  across.triangles(0, 2) = 3;
  CHECK_THROWS_WITH_AS(Surface{across}, doctest::Contains("\"left\" and \"right\""), InputError);

  const Surface surface(two_triangles());
  Positions q = Positions::Zero(6, 3);
  q(4, 1) = std::nan("");
  CHECK_THROWS_WITH_AS(surface.check_positions(q), "object \"right\", vertex 1: coordinate is not finite", InputError);
  CHECK_THROWS_AS(surface.check_positions(Positions::Zero(5, 3)), InputError);
  q(4, 1) = 0.9e-70;
  CHECK_THROWS_WITH_AS(surface.check_positions(q),
                       "object \"right\", vertex 1: coordinate is below 1e-70; set it to 0 or scale up", InputError);
  q(4, 1) = -1.1e70;
  CHECK_THROWS_WITH_AS(surface.check_positions(q),
                       "object \"right\", vertex 1: coordinate is above 1e70; scale the object down", InputError);
}

TEST_CASE("surface: empty input is a surface") {
  const Surface surface(SurfaceDefinition{});
  CHECK(surface.edges().rows() == 0);
  CHECK(surface.vertex_areas(Positions(0, 3)).size() == 0);
}
