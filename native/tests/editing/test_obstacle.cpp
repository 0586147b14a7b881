// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/editing/obstacle.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "editing/small_scenes.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

/// A sheet of 1,800 triangles: several blocks.
Obstacle sheet() {
  Positions q(0, 3);
  Triangles triangles(0, 3);
  append_sheet(q, triangles, 30, 3, Vector3::Zero());
  return {"Sheet", q, triangles, Execution(2)};
}

}  // namespace

TEST_CASE("obstacle: triangles near a box are those whose bounds touch it") {
  const Obstacle obstacle = sheet();
  for (const double at : {-1.45, -0.3, 0.0, 0.71, 1.5, 2.0}) {
    const Eigen::AlignedBox3d box(Vector3(at, at, -0.1), Vector3(at + 0.4, at + 0.2, 0.1));
    std::vector<Index> expected;
    for (Index triangle = 0; triangle < obstacle.triangles().rows(); ++triangle) {
      const auto corner = [&](Index k) { return obstacle.positions().row(obstacle.triangles()(triangle, k)); };
      const Eigen::RowVector3d low = corner(0).cwiseMin(corner(1)).cwiseMin(corner(2));
      const Eigen::RowVector3d high = corner(0).cwiseMax(corner(1)).cwiseMax(corner(2));
      const bool apart =
          (low.array() > box.max().transpose().array()).any() || (high.array() < box.min().transpose().array()).any();
      if (!apart) expected.push_back(triangle);
    }
    for (const int threads : {1, 2}) CHECK(obstacle.triangles_near(box, Execution(threads)) == expected);
    CHECK(obstacle.count_near(box) >= static_cast<Index>(expected.size()));
  }
  CHECK(obstacle.count_near({Vector3(5, 5, 5), Vector3(6, 6, 6)}) == 0);
}

TEST_CASE("obstacle: triangles within a distance of a box, and the closest corner, are those of all triangles") {
  const Obstacle obstacle = sheet();
  const Eigen::AlignedBox3d box(Vector3(0.2, 2.0, 0.5), Vector3(0.3, 2.5, 0.7));
  for (const double distance : {0.4, 0.75, 1.3, 9.0}) {
    std::vector<Index> expected;
    for (Index triangle = 0; triangle < obstacle.triangles().rows(); ++triangle) {
      Eigen::AlignedBox3d bounds;
      for (const Index corner : obstacle.triangles().row(triangle))
        bounds.extend(Vector3(obstacle.positions().row(corner)));
      if (bounds.exteriorDistance(box) <= distance) expected.push_back(triangle);
    }
    CHECK(obstacle.triangles_near(box, Execution(2), distance) == expected);
  }
  for (const Vector3& point : {Vector3(0.21, -0.3, 0.4), Vector3(-7, 1, 2), Vector3(1.5, 1.5, 0)}) {
    const double least = (obstacle.positions().rowwise() - point.transpose()).rowwise().norm().minCoeff();
    const auto corner = obstacle.corner_near(point, least + 1);
    REQUIRE(corner);
    CHECK((*corner - point).norm() == doctest::Approx(least));
    CHECK_FALSE(obstacle.corner_near(point, 0.999 * least));
  }
}

TEST_CASE("obstacle: refusals name object and element") {
  Positions q = Positions::Zero(3, 3);
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 1, 3;
  CHECK_THROWS_WITH_AS(Obstacle("Rock", q, triangles), "object \"Rock\", face 1: vertex index 3 is out of range 0..2",
                       InputError);
  q(2, 1) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH_AS(Obstacle("Rock", q, triangles), "object \"Rock\", vertex 2: coordinate is not finite",
                       InputError);
  CHECK(Obstacle("Nothing", Positions(0, 3), Triangles(0, 3)).count_near({Vector3(0, 0, 0), Vector3(1, 1, 1)}) == 0);
}
