// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/crossings.hpp"

#include <doctest/doctest.h>

#include "penetration/boxes.hpp"
#include "penetration/placed_pair.hpp"

using namespace stiv;

namespace {

/// Tetrahedra with corners on a coarse grid, so that all kinds of contact occur.
Assembly tetrahedra_on_grid(std::mt19937& random) {
  std::uniform_int_distribution<int> coordinate(0, 3);
  Assembly scene;
  for (int body = 0; body < 2; ++body) {
    std::vector<Vector3> corners;
    for (int k = 0; k < 4; ++k) corners.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    add_body(scene, corners, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  }
  return scene;
}

std::vector<std::array<Index, 2>> triangles_of_cuts(const Crossings& crossings) {
  std::vector<std::array<Index, 2>> triangles;
  for (const Cut& cut : crossings.cuts()) triangles.push_back(cut.triangles);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

Vector3 end_of(const Crossings& crossings, const Cut& cut, std::size_t side, std::size_t end) {
  const Triangle t = crossings.body(side).triangle(cut.triangles[side]);
  return t[0] + cut.ends[side][end][0] * (t[1] - t[0]) + cut.ends[side][end][1] * (t[2] - t[0]);
}

}  // namespace

TEST_CASE("bodies that touch have the crossings of a slightly translated second body") {
  std::mt19937 random(9);
  int touching = 0, cuts = 0;
  for (int round = 0; round < 2000; ++round) {
    Assembly scene = tetrahedra_on_grid(random);
    const int perturbation = round % 2 == 0 ? 1 : -1;
    const PlacedPair on_grid(scene);
    scene.q.bottomRows(4).rowwise() += perturbation * Eigen::RowVector3d(0x1p-12, 0x1p-24, 0x1p-36);
    const PlacedPair moved(scene);
    const Crossings perturbed = on_grid.crossings(perturbation), general = moved.crossings(perturbation);
    REQUIRE(triangles_of_cuts(perturbed) == triangles_of_cuts(general));
    for (std::size_t side : {0, 1})
      for (Index a = 0; a < 4; ++a)
        for (Index b = 0; b < 4; ++b)
          REQUIRE(perturbed.winding_increase(side, a, b) == general.winding_increase(side, a, b));
    touching += perturbed.touching();
    cuts += !perturbed.cuts().empty();
  }
  CHECK(touching > 1000);
  CHECK(cuts > 500);
}

TEST_CASE("the ends of a cut are in both triangles, ordered along the cross product of their normals") {
  std::mt19937 random(2);
  int cuts = 0;
  for (const double scale : {1e-7, 1.0, 1e7})
    for (int round = 0; round < 30; ++round) {
      Assembly scene;
      add_box(scene, random_frame(random, 0.6));
      add_sheet(scene, 3, random_frame(random, 0.6));
      scene.q *= scale;
      const PlacedPair pair(scene);
      const Crossings crossings = pair.crossings();
      CHECK_FALSE(crossings.touching());
      for (const Cut& cut : crossings.cuts()) {
        for (std::size_t end : {0, 1})
          CHECK((end_of(crossings, cut, 0, end) - end_of(crossings, cut, 1, end)).norm() < 1e-12 * scale);
        const Vector3 along = end_of(crossings, cut, 0, 1) - end_of(crossings, cut, 0, 0);
        const Vector3 product =
            pair.first.area_vector(cut.triangles[0]).cross(pair.second.area_vector(cut.triangles[1]));
        CHECK(along.dot(product) == doctest::Approx(along.norm() * product.norm()).epsilon(1e-6));
        ++cuts;
      }
    }
  CHECK(cuts > 100);
}

TEST_CASE("the mean along an edge is its fraction inside") {
  Assembly scene;
  add_box(scene, Eigen::Affine3d::Identity());
  add_body(scene, {{-3, 0.5, 0.25}, {5, 0.75, 0.5}, {9, 9, 9}}, {{0, 1, 2}});
  const PlacedPair pair(scene);
  const Crossings crossings = pair.crossings();
  CHECK(crossings.mean_along(1, 0, 1, 0) == doctest::Approx(0.5));
  CHECK(crossings.mean_along(1, 1, 0, 0) == doctest::Approx(0.5));
  CHECK(crossings.winding_increase(1, 0, 1) == 0);
}
