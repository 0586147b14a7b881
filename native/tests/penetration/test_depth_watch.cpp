// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/depth_watch.hpp"

#include <doctest/doctest.h>

#include "penetration/boxes.hpp"

using namespace stiv;

namespace {

constexpr Index sheet_vertices = 25;
constexpr double rounding = 1e-6;

/// A sheet from x = 1 to 3, and a box that ends at x = 2.
Assembly sheet_half_in_box() {
  Assembly scene;
  add_sheet(scene, 4, Eigen::Affine3d(Eigen::Translation3d(2, 0.1, 0.3)));
  add_box(scene, Eigen::Affine3d::Identity());
  return scene;
}

/// The watch of an assembly at its start, and questions about where its first body is then.
struct Watched {
  explicit Watched(const Assembly& scene)
      : surface(scene.surface()), start(scene.q), watch(surface, intersecting(start), rounding) {
    CHECK_FALSE(watch.begun());
    watch.begin(start, intersecting(start));
    CHECK(watch.begun());
  }

  bool is_deeper_when_moved(const Vector3& offset) {
    Positions q = start;
    q.topRows(sheet_vertices).rowwise() += offset.transpose();
    return is_deeper(q);
  }
  bool is_deeper(const Positions& q) { return watch.is_deeper(q, intersecting(q)); }

  IndexPairs intersecting(const Positions& q) const {
    Execution execution(1);
    return IntersectionTest(surface).find(q, execution);
  }

  std::shared_ptr<const Surface> surface;
  Positions start;
  DepthWatch watch;
};

}  // namespace

TEST_CASE("a sheet goes no deeper into a box, but out, along, and back to where it began") {
  Watched sheet(sheet_half_in_box());
  CHECK_FALSE(sheet.is_deeper(sheet.start));
  CHECK(sheet.is_deeper_when_moved({-0.1, 0, 0}));
  CHECK_FALSE(sheet.is_deeper_when_moved({0.3, 0, 0}));
  CHECK_FALSE(sheet.is_deeper_when_moved({0, 0.2, -0.4}));
  CHECK_FALSE(sheet.is_deeper_when_moved({5, 0, 0}));
  CHECK(sheet.is_deeper_when_moved({-1, 0, 0}));
  CHECK_FALSE(sheet.is_deeper(sheet.start));
}

TEST_CASE("what rounding may hide is let through, and no more") {
  Watched sheet(sheet_half_in_box());
  CHECK_FALSE(sheet.is_deeper_when_moved({-0.9 * rounding, 0, 0}));
  CHECK(sheet.is_deeper_when_moved({-1.1 * rounding, 0, 0}));
}

TEST_CASE("what stretches without going in is no deeper") {
  Watched sheet(sheet_half_in_box());
  Positions q = sheet.start;
  q.topRows(sheet_vertices).col(1) *= 1.4;
  CHECK_FALSE(sheet.is_deeper(q));
}

TEST_CASE("the box may not come over the sheet either") {
  Watched sheet(sheet_half_in_box());
  Positions q = sheet.start;
  q.bottomRows(8).col(0).array() += 0.1;
  CHECK(sheet.is_deeper(q));
  q.bottomRows(8).col(0).array() -= 0.2;
  CHECK_FALSE(sheet.is_deeper(q));
}

TEST_CASE("a sheet that lies on a box is not pressed into it, and slides and leaves") {
  Assembly scene;
  add_sheet(scene, 4, Eigen::Affine3d(Eigen::Translation3d(0.5, 0.25, 2)));
  add_box(scene, Eigen::Affine3d::Identity());
  Watched sheet(scene);
  CHECK_FALSE(sheet.is_deeper_when_moved({0.25, -0.5, 0}));
  CHECK_FALSE(sheet.is_deeper_when_moved({0, 0, 0.1}));
  CHECK(sheet.is_deeper_when_moved({0, 0, -0.1}));
}

TEST_CASE("two boxes that touch in a face are not pressed into each other, and slide and leave") {
  Assembly scene;
  add_box(scene, Eigen::Affine3d::Identity());
  add_box(scene, Eigen::Affine3d(Eigen::Translation3d(4, 1, 0)));
  Watched boxes(scene);
  const auto is_deeper = [&](const Vector3& offset) {
    Positions q = boxes.start;
    q.topRows(8).rowwise() += offset.transpose();
    return boxes.is_deeper(q);
  };
  CHECK(is_deeper({0.01, 0, 0}));
  CHECK_FALSE(is_deeper({-0.01, 0, 0}));
  CHECK_FALSE(is_deeper({0, 0.7, 1.3}));
}

TEST_CASE("two sheets are not watched") {
  Assembly scene;
  add_sheet(scene, 4, Eigen::Affine3d::Identity());
  add_sheet(scene, 4, Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(1.2, Vector3::UnitX()));
  Watched sheets(scene);
  CHECK_FALSE(sheets.is_deeper_when_moved({0, 0, 0.2}));
  CHECK_FALSE(sheets.is_deeper_when_moved({0, 0, -0.2}));
}
