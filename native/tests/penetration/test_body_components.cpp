// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/body_components.hpp"

#include <doctest/doctest.h>

#include "penetration/boxes.hpp"

using namespace stiv;

namespace {

const Eigen::Affine3d unit = Eigen::Affine3d::Identity();

bool is_closed(const Assembly& assembly) {
  const BodyComponents parts = body_components(*assembly.surface(), 0);
  CHECK(parts.closed.empty() != parts.open.empty());
  return parts.open.empty();
}

}  // namespace

TEST_CASE("a box is closed; a sheet, a box without one triangle and a box with a reversed one are open") {
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

TEST_CASE("two boxes that share an edge are closed, also with triangles of repeated corners") {
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

TEST_CASE("the triangles of a body with closed and open components are divided") {
  Assembly scene;
  add_sheet(scene, 2, unit);
  add_box(scene, Eigen::Affine3d(Eigen::Translation3d(9, 0, 0)));
  scene.definition.vertex_body.assign(scene.definition.vertex_body.size(), 0);
  const BodyComponents parts = body_components(*scene.surface(), 0);
  CHECK(parts.open == std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(parts.closed == std::vector<Index>{8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19});
  CHECK(body_components(*scene.surface(), 1).open.empty());
}
