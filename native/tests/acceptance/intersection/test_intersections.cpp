// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "acceptance/shapes.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/error.hpp"

using namespace stiv;

namespace {

using Corners = std::array<Index, 3>;

IndexPairs brute_force(const Surface& surface, const Positions& q) {
  const Triangles& faces = surface.triangles();
  const auto corners = [&](Index face) { return Corners{faces(face, 0), faces(face, 1), faces(face, 2)}; };
  IndexPairs pairs;
  for (Index a = 0; a < faces.rows(); ++a)
    for (Index b = a + 1; b < faces.rows(); ++b)
      if (surface.bodies_meet(surface.body_of(faces(a, 0)), surface.body_of(faces(b, 0))) &&
          triangles_intersect(corners(a), corners(b), q))
        pairs.emplace_back(a, b);
  return pairs;
}

IndexPairs find(const std::shared_ptr<const Surface>& surface, const Positions& q, int threads) {
  Execution execution(threads);
  return IntersectionTest(surface).find(q, execution);
}

bool is_free(IntersectionTest& test, const Positions& q, const std::vector<unsigned char>& moved = {}) {
  Execution execution(1);
  return test.is_free(q, moved, execution);
}

}  // namespace

TEST_CASE("intersections: the tree equals brute force, for any number of threads") {
  std::mt19937 random(5);
  Assembly scene;
  scene.add_soup(150, 0.1, Mobility::deformable, random);
  scene.add_soup(150, 0.1, Mobility::rigid, random);
  scene.add_soup(150, 0.1, Mobility::fixed, random);
  scene.add_soup(150, 0.1, Mobility::fixed, random);
  scene.definition.ignored = {{0, 3}};
  const auto surface = scene.surface();
  for (const double scale : {1e-7, 1.0, 1e7}) {
    const Positions q = scale * scene.q;
    const IndexPairs expected = brute_force(*surface, q);
    CHECK(expected.size() > 100);
    for (const int threads : {1, 2, 3}) CHECK(find(surface, q, threads) == expected);
  }
}

TEST_CASE("intersections: triangulations of a flip face are tested against all but each other") {
  SurfaceDefinition definition;
  definition.vertex_count = 7;
  definition.triangles.resize(5, 3);
  definition.triangles << 0, 1, 2, 0, 2, 3, 0, 1, 3, 1, 2, 3, 4, 5, 6;
  Positions q(7, 3);  // a flat square, triangulated both ways, and a triangle in its corner beside one diagonal
  q << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.6, 0.2, -1, 0.6, 0.2, 1, 0.7, 0.25, 1;
  CHECK(find(std::make_shared<const Surface>(definition), q, 1).size() > 2);
  definition.flip_faces = {{0, 1, 2, 3}};
  CHECK(find(std::make_shared<const Surface>(definition), q, 1) == IndexPairs{{0, 4}, {2, 4}});
}

TEST_CASE("intersections: cached trees follow the positions") {
  std::mt19937 random(6);
  Assembly scene;
  scene.add_soup(200, 0.1, Mobility::deformable, random);
  const auto surface = scene.surface();
  IntersectionTest test(surface);
  Execution execution(2);
  for (int round = 0; round < 5; ++round) {
    CHECK(test.find(scene.q, execution) == brute_force(*surface, scene.q));
    scene.q += 0.3 * Positions::Random(scene.q.rows(), 3);
  }
}

TEST_CASE("intersections: bodies at rest stay unchanged while others move, test after test") {
  std::mt19937 random(12);
  Assembly scene;
  scene.add_soup(120, 0.1, Mobility::deformable, random);
  scene.add_soup(200, 0.1, Mobility::fixed, random);
  scene.add_soup(80, 0.1, Mobility::deformable, random);
  const auto surface = scene.surface();
  IntersectionTest test(surface);
  std::uniform_real_distribution<double> unit(-1, 1);
  Positions q = scene.q;
  for (int turn = 0; turn < 12; ++turn) {
    const Positions before = q;
    const Index body = turn % 3;
    for (Index vertex = 0; vertex < q.rows(); ++vertex)
      if (surface->body_of(vertex) == body)
        for (Index axis = 0; axis < 3; ++axis) q(vertex, axis) += 0.05 * unit(random);
    std::vector<unsigned char> moved;
    for (Index vertex = 0; vertex < q.rows(); ++vertex) moved.push_back(q.row(vertex) != before.row(vertex));
    IntersectionTest fresh(surface);
    CHECK(is_free(test, q, moved) == is_free(fresh, q, moved));
    Execution cancelled(1), execution(2);
    cancelled.cancel_when([] { return true; });
    if (turn % 4 == 1) CHECK_THROWS_AS(test.find(before, cancelled), Interrupted);
    CHECK(test.find(q, execution) == brute_force(*surface, q));
  }
}

TEST_CASE("intersections: vertices that rest are not looked at again, while stars beside them open and fold") {
  std::mt19937 random(13);
  Assembly scene = linked_tori(12, 8, 0);
  const auto moving = static_cast<Index>(scene.q.rows());
  scene.add_soup(60, 0.3, Mobility::fixed, random);
  const auto surface = scene.surface();
  IntersectionTest test(surface, {.resting = static_cast<Index>(scene.q.rows()) - moving});
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t most = 0, least = 1000000;
  for (const double size : {0.0, 0.3, 0.3, 0.0, 0.02, 0.3, 0.0}) {
    Positions q = scene.q;
    for (Index vertex = 0; vertex < moving; ++vertex)
      for (Index axis = 0; axis < 3; ++axis) q(vertex, axis) += size * unit(random);
    Execution cancelled(1), execution(2);
    cancelled.cancel_when([] { return true; });
    if (size == 0.02) CHECK_THROWS_AS(test.find(q, cancelled), Interrupted);
    const IndexPairs expected = brute_force(*surface, q);
    CHECK(test.find(q, execution) == expected);
    CHECK(is_free(test, q) == expected.empty());
    most = std::max(most, expected.size());
    least = std::min(least, expected.size());
  }
  CHECK(most > least + 20);
}

TEST_CASE("intersections: linked rings are free until one is pulled") {
  for (const double scale : {1e-7, 1.0, 1e7}) {
    const Assembly linked = linked_tori(40, 20, 0), pulled = linked_tori(40, 20, 1.5);
    IntersectionTest test(linked.surface());
    CHECK(is_free(test, scale * linked.q));
    CHECK_FALSE(is_free(test, scale * pulled.q));
    CHECK(find(linked.surface(), scale * pulled.q, 2) == brute_force(*linked.surface(), scale * pulled.q));
  }
}

TEST_CASE("intersections: a flat sheet is free, in any plane") {
  Assembly sheet;
  const Index size = 12, base = sheet.begin_body(size * size, Mobility::deformable);
  const auto vertex = [&](Index i, Index j) { return base + i * size + j; };
  for (Index i = 0; i < size; ++i)
    for (Index j = 0; j < size; ++j) sheet.q.row(vertex(i, j)) << 0.1 * i, 0.1 * j, 0;
  for (Index i = 0; i + 1 < size; ++i)
    for (Index j = 0; j + 1 < size; ++j) {
      sheet.add_triangle(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
      sheet.add_triangle(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  IntersectionTest test(sheet.surface());
  CHECK(is_free(test, sheet.q));
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.3, -0.2, 0.7, 0.4).normalized();
  CHECK(is_free(test, sheet.q * turn.toRotationMatrix()));
  Positions folded = sheet.q;
  folded.row(vertex(3, 3)) = folded.row(vertex(5, 3));
  CHECK_FALSE(is_free(test, folded));
}

TEST_CASE("intersections: only pairs with a moved vertex are tested") {
  Assembly scene;
  std::mt19937 random(7);
  scene.add_soup(60, 0.2, Mobility::deformable, random);
  const auto surface = scene.surface();
  const IndexPairs pairs = brute_force(*surface, scene.q);
  IntersectionTest test(surface);
  CHECK(is_free(test, scene.q, std::vector<unsigned char>(180, 0)));
  for (Index face = 0; face < 60; ++face) {
    std::vector<unsigned char> moved(180, 0);
    moved[3 * static_cast<std::size_t>(face) + 1] = 1;
    const bool meets = std::any_of(pairs.begin(), pairs.end(),
                                   [&](const auto& pair) { return pair.first == face || pair.second == face; });
    CHECK(is_free(test, scene.q, moved) == !meets);
  }
}

TEST_CASE("intersections: loose edges and loose vertices against faces") {
  Assembly scene;
  scene.begin_body(8, Mobility::deformable);
  scene.q << 0, 0, 0, 4, 0, 0, 0, 4, 0,  // a face
      1, 1, 0, 1, 1, 1,                  // an edge whose end touches it
      0, 0, 3, 1, 2, 1,                  // an edge above, and one from a corner of the face
      9, 9, 9;
  scene.add_triangle(0, 1, 2);
  scene.definition.loose_edges.resize(3, 2);
  scene.definition.loose_edges << 3, 4, 5, 6, 0, 6;
  IntersectionTest test(scene.surface());
  Execution execution(1);
  const StaticPairs touching = test.find_all(scene.q, execution);
  CHECK(touching.faces.empty());
  CHECK(touching.loose_edges == IndexPairs{{0, 0}});
  CHECK(touching.loose_vertices.empty());
  CHECK_FALSE(is_free(test, scene.q));
  scene.q.row(3) << 1, 1, 0x1p-40;
  CHECK(is_free(test, scene.q));
  scene.q.row(7) << 0, 0, 0;
  CHECK(test.find_all(scene.q, execution).loose_vertices == IndexPairs{{7, 0}});
  CHECK_FALSE(is_free(test, scene.q));
}

TEST_CASE("intersections: an empty surface is free, and cancelling interrupts") {
  IntersectionTest empty(std::make_shared<const Surface>(SurfaceDefinition{}));
  CHECK(is_free(empty, Positions(0, 3)));
  SurfaceDefinition wire;
  wire.vertex_count = 3;
  wire.loose_edges = Edges::Zero(1, 2);
  IntersectionTest edges_only(std::make_shared<const Surface>(wire));
  CHECK(is_free(edges_only, Positions::Zero(3, 3)));

  const Assembly scene = linked_tori(8, 8, 0);
  IntersectionTest test(scene.surface());
  Execution cancelled(2);
  cancelled.request_cancel();
  CHECK_THROWS_AS(test.is_free(scene.q, {}, cancelled), Interrupted);
}
