// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/penetration.hpp"

#include <doctest/doctest.h>

#include "penetration/boxes.hpp"
#include "penetration/placed_pair.hpp"

using namespace stiv;

namespace {

const Eigen::Affine3d unit = Eigen::Affine3d::Identity();

Eigen::Affine3d at(double x, double y, double z) { return Eigen::Affine3d(Eigen::Translation3d(x, y, z)); }

/// The common volume of two convex bodies, from faces clipped by the planes of the other body.
double convex_volume(const std::vector<Polygon>& first, const std::vector<Polygon>& second) {
  double volume = 0;
  for (const auto& [faces, planes] : {std::pair(first, second), std::pair(second, first)})
    for (const Polygon& face : faces) {
      const Polygon kept = inside(face, planes);
      for (std::size_t k = 2; k < kept.size(); ++k) volume += kept[0].dot(kept[k - 1].cross(kept[k])) / 6;
    }
  return volume;
}

Assembly two_boxes(const Eigen::Affine3d& first, const Eigen::Affine3d& second) {
  Assembly assembly;
  add_box(assembly, first);
  add_box(assembly, second);
  return assembly;
}

Assembly sheet_and_box(const Eigen::Affine3d& sheet, const Eigen::Affine3d& box = unit, Index cells = 4) {
  Assembly assembly;
  add_sheet(assembly, cells, sheet);
  add_box(assembly, box);
  return assembly;
}

/// With uncertainties for a distance of 1.
Penetration volume_of(const Assembly& assembly) {
  const PlacedPair pair(assembly);
  return common_volume(pair.first, pair.second, pair.meeting, 1);
}

std::vector<double> areas_of(const PlacedBody& body) {
  std::vector<double> areas;
  for (Index k = 0; k < body.triangle_count(); ++k) areas.push_back(body.area_vector(k).norm() / 2);
  return areas;
}

Penetration area_of_first(const Assembly& assembly, double rounding = 0) {
  const PlacedPair pair(assembly);
  return area_inside(pair.first, areas_of(pair.first), pair.second, pair.meeting, rounding);
}

}  // namespace

TEST_CASE("the common volume of random boxes equals that from clipped faces") {
  std::mt19937 random(5);
  for (const double scale : {1e-7, 1.0, 1e7}) {
    int crossing = 0;
    for (int k = 0; k < 100; ++k) {
      const Eigen::Affine3d larger(Eigen::Scaling(scale));
      const Eigen::Affine3d first = larger * random_frame(random, 1), second = larger * random_frame(random, 1);
      const double expected = convex_volume(polygons(box_corners(first)), polygons(box_corners(second)));
      const double unit_volume = scale * scale * scale, found = volume_of(two_boxes(first, second)).amount;
      CHECK(found / unit_volume == doctest::Approx(expected / unit_volume).epsilon(1e-12).scale(64));
      crossing += expected > unit_volume && expected < 63 * unit_volume;
    }
    CHECK(crossing > 50);
  }
}

TEST_CASE("a body that faces inward gives a negative common volume and a negative area inside") {
  std::mt19937 random(7);
  Assembly boxes = two_boxes(random_frame(random, 0.3), random_frame(random, 0.3));
  const Penetration outward = volume_of(boxes);
  for (Index row = 0; row < 12; ++row) boxes.definition.triangles.row(row).reverseInPlace();
  CHECK(volume_of(boxes).amount == doctest::Approx(-outward.amount));
  CHECK(volume_of(boxes).uncertainty == doctest::Approx(outward.uncertainty));
  Assembly sheet = sheet_and_box(random_frame(random, 0.1) * Eigen::Scaling(2.0));
  const double area = area_of_first(sheet).amount;
  CHECK(area > 1);
  sheet.definition.triangles.bottomRows(12).rowwise().reverseInPlace();
  CHECK(area_of_first(sheet).amount == doctest::Approx(-area));
}

TEST_CASE("common volume: 0 apart, the whole inside; its uncertainty is that of the inner surface") {
  const Penetration apart = volume_of(two_boxes(unit, at(9, 0, 0)));
  CHECK(apart.amount == 0);
  CHECK(apart.uncertainty == 0);
  const Penetration inner = volume_of(two_boxes(unit, Eigen::Affine3d(Eigen::Scaling(0.5))));
  CHECK(inner.amount == doctest::Approx(8));
  CHECK(inner.uncertainty == doctest::Approx(24));
}

TEST_CASE("the volume in a cavity does not count") {
  std::mt19937 random(11);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Affine3d turn(random_frame(random, 0).linear());
    const Eigen::Affine3d hollow = turn * Eigen::Scaling(0.7), place = Eigen::Translation3d(1.7, 0.2, 0.1) * turn;
    const Eigen::Affine3d small = place * Eigen::Scaling(0.3);
    auto faces = box_faces;
    auto corners = box_corners(unit);
    for (const Vector3& corner : box_corners(hollow)) corners.push_back(corner);
    for (const auto& face : box_faces) {
      std::vector<Index> inward(face.rbegin(), face.rend());
      for (Index& vertex : inward) vertex += 8;
      faces.push_back(inward);
    }
    Assembly assembly;
    add_body(assembly, corners, faces);
    add_box(assembly, small);
    const auto whole = polygons(box_corners(unit)), ball = polygons(box_corners(small));
    const double expected = convex_volume(whole, ball) - convex_volume(polygons(box_corners(hollow)), ball);
    CHECK(volume_of(assembly).amount == doctest::Approx(expected).epsilon(1e-12).scale(64));
  }
}

TEST_CASE("boxes on a grid have the exact common volume for all kinds of contact") {
  for (int x = -5; x <= 5; ++x)
    for (int y = -5; y <= 5; ++y)
      for (int z : {-4, -3, 0, 2}) {
        const double expected =
            std::max(4.0 - std::abs(x), 0.0) * std::max(4.0 - std::abs(y), 0.0) * std::max(4.0 - std::abs(z), 0.0);
        CHECK(volume_of(two_boxes(unit, at(x, y, z))).amount == doctest::Approx(expected).scale(64));
      }
}

TEST_CASE("a sheet half in a box: half of its area, with the uncertainty of the intersection line") {
  const Assembly scene = sheet_and_box(at(2, 0.1, 0.3));  // from x = 1 to 3
  const Penetration found = area_of_first(scene, 1e-3);
  CHECK(found.amount == doctest::Approx(2));
  CHECK(found.uncertainty == doctest::Approx(2e-3));
  const Eigen::Affine3d slanted = at(2, 0.1, 0.3) * Eigen::AngleAxisd(std::numbers::pi / 3, Vector3::UnitY());
  CHECK(area_of_first(sheet_and_box(slanted), 1e-3).uncertainty == doctest::Approx(4e-3));
}

TEST_CASE("the area of random sheets inside boxes equals that from clipped polygons") {
  std::mt19937 random(13);
  for (const double scale : {1e-7, 1.0, 1e7})
    for (int round = 0; round < 40; ++round) {
      const Eigen::Affine3d larger(Eigen::Scaling(scale)), box = larger * random_frame(random, 0.5);
      const Eigen::Affine3d sheet = larger * random_frame(random, 1) * Eigen::Scaling(2.0);
      const Polygon whole{sheet * Vector3(-1, -1, 0), sheet * Vector3(1, -1, 0), sheet * Vector3(1, 1, 0),
                          sheet * Vector3(-1, 1, 0)};
      const double expected = area_of(inside(whole, polygons(box_corners(box)))) / (scale * scale);
      const double found = area_of_first(sheet_and_box(sheet, box)).amount / (scale * scale);
      CHECK(found == doctest::Approx(expected).epsilon(1e-11).scale(16));
    }
}

TEST_CASE("triangles count with their area at the start") {
  const PlacedPair pair(sheet_and_box(at(2, 0.1, 0.3)));
  const PlacedPair smaller(sheet_and_box(at(0.3, 0.1, 0.3) * Eigen::Scaling(0.1)));
  CHECK(area_inside(smaller.first, areas_of(pair.first), smaller.second, smaller.meeting, 0).amount ==
        doctest::Approx(4));
}

TEST_CASE("penetration decreases away from the middle of a box and increases toward it") {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> factor(1, 1.3);
  int changed = 0;
  for (int round = 0; round < 100; ++round) {
    Assembly scene = sheet_and_box(random_frame(random, 0.7) * Eigen::Scaling(2.0));
    const PlacedPair before(scene);
    scene.q.topRows(25) *= factor(random);
    const PlacedPair after(scene);
    const std::vector<double> inner = areas_of(before.first), outer = areas_of(after.first);
    const auto inside_of = [](const PlacedPair& pair, const std::vector<double>& areas) {
      return area_inside(pair.first, areas, pair.second, pair.meeting, 0).amount;
    };
    CHECK(inside_of(after, inner) <= inside_of(before, inner) + 1e-12);
    CHECK(inside_of(before, outer) >= inside_of(after, outer) - 1e-12);
    changed += inside_of(after, inner) < inside_of(before, inner) - 0.1;
  }
  CHECK(changed > 50);
}

TEST_CASE("area on the surface of a closed body counts half, on any side") {
  const Eigen::AngleAxisd upright(std::numbers::pi / 2, Vector3::UnitY());
  for (const double side : {-2.0, 2.0}) {
    CHECK(area_of_first(sheet_and_box(at(0, 0, side))).amount == doctest::Approx(2));
    CHECK(area_of_first(sheet_and_box(at(2, 0, side))).amount == doctest::Approx(1));      // half beyond the edge
    CHECK(area_of_first(sheet_and_box(at(0, side, 0))).amount == doctest::Approx(2));      // across the face: half in
    CHECK(area_of_first(sheet_and_box(at(0, 3 * side / 2, 0))).amount == 0);               // along an edge, outside
    CHECK(area_of_first(sheet_and_box(at(0, side / 2, 0))).amount == doctest::Approx(4));  // inside
  }
  CHECK(area_of_first(sheet_and_box(at(-2, 0.5, 0) * upright)).amount == doctest::Approx(2));
}

TEST_CASE("a triangle that became degenerate counts by its fraction inside") {
  Assembly scene;
  add_body(scene, {{0, 0, 0.25}, {4, 0, 0.25}, {2, 0, 0.25}}, {{0, 1, 2}});
  add_box(scene, unit);
  const PlacedPair pair(scene);
  const Penetration found = area_inside(pair.first, {1}, pair.second, pair.meeting, 0);
  CHECK(found.amount >= 0);
  CHECK(found.amount <= 1);
}
