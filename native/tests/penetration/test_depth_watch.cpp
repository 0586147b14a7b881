// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/depth_watch.hpp"

#include <doctest/doctest.h>

#include "editing/small_scenes.hpp"
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

/// The depth watch of an assembly, and tests with its first body displaced.
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

TEST_CASE("a sheet may leave a box, move along it and return, but not penetrate deeper") {
  Watched sheet(sheet_half_in_box());
  CHECK_FALSE(sheet.is_deeper(sheet.start));
  CHECK(sheet.is_deeper_when_moved({-0.1, 0, 0}));
  CHECK_FALSE(sheet.is_deeper_when_moved({0.3, 0, 0}));
  CHECK_FALSE(sheet.is_deeper_when_moved({0, 0.2, -0.4}));
  CHECK_FALSE(sheet.is_deeper_when_moved({5, 0, 0}));
  CHECK(sheet.is_deeper_when_moved({-1, 0, 0}));
  CHECK_FALSE(sheet.is_deeper(sheet.start));
}

TEST_CASE("a penetration within rounding is accepted, a larger one is not") {
  Watched sheet(sheet_half_in_box());
  CHECK_FALSE(sheet.is_deeper_when_moved({-0.9 * rounding, 0, 0}));
  CHECK(sheet.is_deeper_when_moved({-1.1 * rounding, 0, 0}));
}

TEST_CASE("stretching does not count as penetration") {
  Watched sheet(sheet_half_in_box());
  Positions q = sheet.start;
  q.topRows(sheet_vertices).col(1) *= 1.4;
  CHECK_FALSE(sheet.is_deeper(q));
}

TEST_CASE("the box may not move over the sheet") {
  Watched sheet(sheet_half_in_box());
  Positions q = sheet.start;
  q.bottomRows(8).col(0).array() += 0.1;
  CHECK(sheet.is_deeper(q));
  q.bottomRows(8).col(0).array() -= 0.2;
  CHECK_FALSE(sheet.is_deeper(q));
}

TEST_CASE("a sheet on a box may slide and leave, but not be pressed into it") {
  Assembly scene;
  add_sheet(scene, 4, Eigen::Affine3d(Eigen::Translation3d(0.5, 0.25, 2)));
  add_box(scene, Eigen::Affine3d::Identity());
  Watched sheet(scene);
  CHECK_FALSE(sheet.is_deeper_when_moved({0.25, -0.5, 0}));
  CHECK_FALSE(sheet.is_deeper_when_moved({0, 0, 0.1}));
  CHECK(sheet.is_deeper_when_moved({0, 0, -0.1}));
}

TEST_CASE("two boxes that touch in a face may slide and leave, but not be pressed into each other") {
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

TEST_CASE("two open bodies are not measured") {
  Assembly scene;
  add_sheet(scene, 4, Eigen::Affine3d::Identity());
  add_sheet(scene, 4, Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(1.2, Vector3::UnitX()));
  Watched sheets(scene);
  CHECK_FALSE(sheets.is_deeper_when_moved({0, 0, 0.2}));
  CHECK_FALSE(sheets.is_deeper_when_moved({0, 0, -0.2}));
}

TEST_CASE("a body is displaced if any bit of a vertex changed") {
  const tests::Scene scene = tests::two_sheets();
  const Positions& from = scene.controls;
  Positions to = from;
  CHECK(displaced_bodies(*scene.surface, from, to) == std::vector<unsigned char>{0, 0});
  to(60, 1) = std::nextafter(to(60, 1), 9.0);
  CHECK(displaced_bodies(*scene.surface, from, to) == std::vector<unsigned char>{0, 1});
  to(0, 2) += 1;
  CHECK(displaced_bodies(*scene.surface, from, to) == std::vector<unsigned char>{1, 1});
}
