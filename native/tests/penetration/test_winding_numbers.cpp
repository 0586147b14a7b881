// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/winding_numbers.hpp"

#include <doctest/doctest.h>

#include "penetration/boxes.hpp"
#include "penetration/placed_pair.hpp"
#include "penetration/solid_angles.hpp"

using namespace stiv;

namespace {

/// A perturbation large enough for solid angles and small relative to integers.
const Vector3 visible_nudge(0x1p-7, 0x1p-14, 0x1p-21);

}  // namespace

TEST_CASE("winding numbers along rays and along edges equal those of solid angles") {
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

TEST_CASE("points on faces, edges and corners are inside or outside by their perturbation") {
  Assembly scene;
  add_box(scene, Eigen::Affine3d::Identity());
  const auto surface = scene.surface();
  const BodyMesh mesh = whole_body(*surface, 0);
  const PlacedBody box(mesh, scene.q);
  int inside = 0;
  for (int perturbation : {1, -1})
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y)
        for (int z = -3; z <= 3; ++z) {
          const Vector3 point(x, y, z), perturbed = point + perturbation * visible_nudge;
          const double expected = winding_by_solid_angles(surface->triangles(), scene.q, perturbed);
          REQUIRE(winding_number(box, point, perturbation) == static_cast<int>(std::round(expected)));
          inside += winding_number(box, point, perturbation);
        }
  CHECK(inside == 2 * 4 * 4 * 4);  // of 5 x 5 x 5 points on and in the box one layer is outside along each axis
}

TEST_CASE("winding numbers of a flat body, of one in the plane of the ray's start, and of one inside itself") {
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

namespace {

/// The mean winding number at (n / 2) (n + 1) evenly distributed points of a triangle.
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

TEST_CASE("a sheet in a box: mean winding numbers are the fractions of area inside, at any scale") {
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

TEST_CASE("two tori: mean winding numbers are those of sampled points") {
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

TEST_CASE("nearly coplanar cuts: mean winding numbers stay between 0 and 1") {
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
