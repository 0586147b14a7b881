// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/mean_windings.hpp"

#include <doctest/doctest.h>

#include "penetration/boxes.hpp"
#include "penetration/placed_pair.hpp"
#include "penetration/solid_angles.hpp"

using namespace stiv;

namespace {

/// The mean winding number at points in a triangle, (n / 2) (n + 1) of them, evenly spread.
double sampled(const Triangles& closed, const Positions& q, const Triangle& t, int n) {
  double sum = 0;
  int count = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j, ++count) {
      const Vector3 point = t[0] + (i + 1.0 / 3) / n * (t[1] - t[0]) + (j + 1.0 / 3) / n * (t[2] - t[0]);
      sum += std::round(winding_by_solid_angles(closed, q, point));
    }
  return sum / count;
}

}  // namespace

TEST_CASE("of a sheet in a box each triangle is in by what planes leave of it, at any scale") {
  std::mt19937 random(4);
  int partly = 0;
  for (const double scale : {1e-7, 1.0, 1e7})
    for (int round = 0; round < 40; ++round) {
      const Eigen::Affine3d larger = Eigen::Affine3d(Eigen::Scaling(scale)), box = larger * random_frame(random, 0.5);
      Assembly scene;
      add_sheet(scene, 4, larger * random_frame(random, 1) * Eigen::Scaling(2.0));
      add_box(scene, box);
      const PlacedPair pair(scene);
      const std::vector<double> means = mean_windings(pair.crossings(), 0);
      const auto faces = polygons(box_corners(box));
      for (Index k = 0; k < pair.first.triangle_count(); ++k) {
        const Triangle t = pair.first.triangle(k);
        const Polygon whole(t.begin(), t.end());
        const double expected = area_of(inside(whole, faces)) / area_of(whole);
        CHECK(means[static_cast<std::size_t>(k)] == doctest::Approx(expected).epsilon(1e-10).scale(1));
        partly += expected > 0.01 && expected < 0.99;
      }
    }
  CHECK(partly > 500);
}

TEST_CASE("of a box in a sheet's place, a torus in a torus: the mean over points in each triangle") {
  std::mt19937 random(6);
  Assembly scene = linked_tori(9, 7, -1.4);
  const PlacedPair pair(scene);
  const Crossings crossings = pair.crossings();
  REQUIRE(crossings.cuts().size() > 20);
  for (const std::size_t side : {0, 1}) {
    const Index count = pair.first.triangle_count();
    const Triangles closed =
        side == 0 ? scene.definition.triangles.bottomRows(count) : scene.definition.triangles.topRows(count);
    const std::vector<double> means = mean_windings(crossings, side);
    for (Index k = 0; k < count; ++k)
      CHECK(means[static_cast<std::size_t>(k)] ==
            doctest::Approx(sampled(closed, scene.q, crossings.body(side).triangle(k), 24)).epsilon(0.05).scale(1));
  }
}

TEST_CASE("nearly flat cuts, where rounding leaves no angle, still give parts between none and all") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> tilt(-1e-15, 1e-15);
  for (int round = 0; round < 200; ++round) {
    Assembly scene;
    add_sheet(scene, 3, Eigen::Affine3d(Eigen::Translation3d(0.1, 0.2, 2)));
    add_box(scene, Eigen::Affine3d::Identity());
    for (Index vertex = 0; vertex < 16; ++vertex) scene.q(vertex, 2) += tilt(random);
    const PlacedPair pair(scene);
    for (const double mean : mean_windings(pair.crossings(), 0)) {
      CHECK(mean > -1e-6);
      CHECK(mean < 1 + 1e-6);
    }
  }
}
