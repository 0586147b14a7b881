// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/common_volume.hpp"

#include <doctest/doctest.h>

#include <random>

#include "shapes.hpp"

using namespace stiv;

namespace {

using Polygon = std::vector<Vector3>;

/// A body with flat faces given by loops of vertices that run counter-clockwise seen from outside, cut into fans.
void add_body(Assembly& assembly, const std::vector<Vector3>& corners, const std::vector<std::vector<Index>>& faces) {
  const Index base = assembly.begin_body(static_cast<Index>(corners.size()), Mobility::deformable);
  for (std::size_t k = 0; k < corners.size(); ++k) assembly.q.row(base + static_cast<Index>(k)) = corners[k];
  for (const auto& face : faces)
    for (std::size_t k = 2; k < face.size(); ++k)
      assembly.add_triangle(base + face[0], base + face[k - 1], base + face[k]);
}

const std::vector<std::vector<Index>> box_faces{{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                                {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};

std::vector<Vector3> box_corners(const Eigen::Affine3d& frame) {
  std::vector<Vector3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back(frame * Vector3((k & 4) - 2, 2 * (k & 2) - 2, 4 * (k & 1) - 2));
  return corners;  // a cube of side 4
}

Eigen::Affine3d random_frame(std::mt19937& random, double reach) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random));
  return Eigen::Translation3d(reach * Vector3(normal(random), normal(random), normal(random))) * turn.normalized();
}

/// The part of a polygon behind the plane of another.
Polygon behind(const Polygon& polygon, const Polygon& plane) {
  const Vector3 normal = (plane[1] - plane[0]).cross(plane[2] - plane[0]);
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double da = normal.dot(a - plane[0]), db = normal.dot(b - plane[0]);
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept.push_back(a + da / (da - db) * (b - a));
  }
  return kept;
}

/// The volume that two convex bodies have in common, from their faces cut by the planes of each other's.
double convex_volume(const std::vector<Polygon>& first, const std::vector<Polygon>& second) {
  double volume = 0;
  for (const auto& [faces, planes] : {std::pair(first, second), std::pair(second, first)})
    for (Polygon face : faces) {
      for (const Polygon& plane : planes)
        if (face.size() > 2) face = behind(face, plane);
      for (std::size_t k = 2; k < face.size(); ++k) volume += face[0].dot(face[k - 1].cross(face[k])) / 6;
    }
  return volume;
}

std::vector<Polygon> polygons(const std::vector<Vector3>& corners) {
  std::vector<Polygon> faces;
  for (const auto& face : box_faces) {
    Polygon& polygon = faces.emplace_back();
    for (const Index k : face) polygon.push_back(corners[static_cast<std::size_t>(k)]);
  }
  return faces;
}

std::optional<CommonVolume> measured(const Assembly& assembly) {
  const auto surface = assembly.surface();
  const CommonVolumes volumes(surface, {{0, static_cast<Index>(surface->triangles().rows()) - 1}});
  REQUIRE_FALSE(volumes.empty());
  Execution execution(1);
  return volumes.at(assembly.q, IntersectionTest(surface).find(assembly.q, execution)).front();
}

Assembly two_boxes(const Eigen::Affine3d& first, const Eigen::Affine3d& second) {
  Assembly assembly;
  add_body(assembly, box_corners(first), box_faces);
  add_body(assembly, box_corners(second), box_faces);
  return assembly;
}

}  // namespace

TEST_CASE("the common volume of random boxes is that of their faces cut by planes, wherever they are") {
  std::mt19937 random(5);
  int crossing = 0;
  for (int k = 0; k < 200; ++k) {
    const Eigen::Affine3d first = random_frame(random, 1), second = random_frame(random, 1);
    const double expected = convex_volume(polygons(box_corners(first)), polygons(box_corners(second)));
    const auto found = measured(two_boxes(first, second));
    REQUIRE(found);
    CHECK(found->volume == doctest::Approx(expected).epsilon(1e-12).scale(64));
    crossing += expected > 1 && expected < 63;
  }
  CHECK(crossing > 100);
}

TEST_CASE("a body that faces inward has the same volume in common") {
  std::mt19937 random(7);
  Assembly boxes = two_boxes(random_frame(random, 0.3), random_frame(random, 0.3));
  const auto outward = measured(boxes);
  REQUIRE(outward);
  for (Index row = 0; row < 12; ++row) boxes.definition.triangles.row(row).reverseInPlace();
  const auto inward = measured(boxes);
  REQUIRE(inward);
  CHECK(inward->volume == doctest::Approx(outward->volume));
  CHECK(inward->area == doctest::Approx(outward->area));
}

TEST_CASE("apart there is none, inside it is the whole, and the area is that of the inner surface") {
  const Eigen::Affine3d unit = Eigen::Affine3d::Identity();
  const auto apart = measured(two_boxes(unit, Eigen::Affine3d(Eigen::Translation3d(9, 0, 0))));
  REQUIRE(apart);
  CHECK(apart->volume == 0);
  CHECK(apart->area == 0);
  const auto inside = measured(two_boxes(unit, Eigen::Affine3d(Eigen::Scaling(0.5))));
  REQUIRE(inside);
  CHECK(inside->volume == doctest::Approx(8));
  CHECK(inside->area == doctest::Approx(24));
}

TEST_CASE("a cavity does not count: only what is in the wall") {
  std::mt19937 random(11);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Affine3d turn(random_frame(random, 0).linear());
    const Eigen::Affine3d hollow = turn * Eigen::Scaling(0.7), place = Eigen::Translation3d(1.7, 0.2, 0.1) * turn;
    const Eigen::Affine3d small = place * Eigen::Scaling(0.3);
    auto faces = box_faces;
    auto corners = box_corners(Eigen::Affine3d::Identity());
    for (const Vector3& corner : box_corners(hollow)) corners.push_back(corner);
    for (const auto& face : box_faces) {
      std::vector<Index> inward(face.rbegin(), face.rend());
      for (Index& vertex : inward) vertex += 8;
      faces.push_back(inward);
    }
    Assembly assembly;
    add_body(assembly, corners, faces);
    add_body(assembly, box_corners(small), box_faces);
    const auto found = measured(assembly);
    REQUIRE(found);
    const auto whole = polygons(box_corners(Eigen::Affine3d::Identity())), ball = polygons(box_corners(small));
    const double expected = convex_volume(whole, ball) - convex_volume(polygons(box_corners(hollow)), ball);
    CHECK(found->volume == doctest::Approx(expected).epsilon(1e-12).scale(64));
  }
}

TEST_CASE("what touches without crossing is not told, and what is open is not watched") {
  const Eigen::Affine3d unit = Eigen::Affine3d::Identity();
  CHECK_FALSE(measured(two_boxes(unit, Eigen::Affine3d(Eigen::Translation3d(4, 1, 1)))));
  CHECK_FALSE(measured(two_boxes(unit, Eigen::Affine3d(Eigen::Translation3d(2, 0, 0)))));
  Assembly open = two_boxes(unit, Eigen::Affine3d(Eigen::Translation3d(1, 1.5, 0.3)));
  open.definition.triangles.conservativeResize(23, 3);
  CHECK(CommonVolumes(open.surface(), {{0, 20}}).empty());
  CHECK(CommonVolumes(open.surface(), {{0, 3}}).empty());  // one body alone
}
