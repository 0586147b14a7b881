// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "stiv/volumes/published.hpp"

using namespace stiv;

namespace {

/// A vertex 0 that falls from z = 1 to `depth` onto the triangle 1, 2, 3 in z = 0, which itself moves by `lift`.
struct Fall {
  Surface surface;
  Positions start = Positions(4, 3), end = Positions(4, 3);
  Event event;

  Fall(double depth, double lift) : surface(definition()) {
    start << 0.2, 0.3, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0;
    end = start;
    end(0, 2) = depth;
    end.col(2).tail(3).array() += lift;
    event.vertices = {0, 1, 2, 3};
    event.time = 1 / (1 - depth + lift);
    event.weights = {1, -0.5, -0.2, -0.3};
    event.normal = Vector3::UnitZ();
    event.start_distance = 1;
  }

  static SurfaceDefinition definition() {
    SurfaceDefinition definition;
    definition.vertex_count = 4;
    definition.triangles.resize(1, 3);
    definition.triangles << 1, 2, 3;
    return definition;
  }

  std::vector<Stiv> volumes(ConstraintKind kind) const {
    Eigen::VectorXd areas(4);
    areas << 0.5, 2, 3, 5;
    return published_volumes(surface, {event}, start, end, areas, kind);
  }
};

}  // namespace

TEST_CASE("published volumes: of a vertex that falls onto a face at rest, (1 - t) of its own way times its area") {
  const std::vector<Stiv> stivs = Fall(-3, 0).volumes(ConstraintKind::per_patch);
  REQUIRE(stivs.size() == 1);  // the face has no motion, so no volume
  CHECK(stivs[0].volume == doctest::Approx(0.5 * (1 - 0.25) * -4));
  REQUIRE(stivs[0].gradient.index == std::vector<Index>{0});
  CHECK(stivs[0].gradient.value[0].isApprox(Vector3(0, 0, 0.5 * (1 - 0.25))));
}

TEST_CASE("published volumes: each side counts by its own motion, with the normal turned against it") {
  const Fall fall(-2, 2);  // they meet at 1/5
  const std::vector<Stiv> stivs = fall.volumes(ConstraintKind::per_patch);
  REQUIRE(stivs.size() == 2);  // by neighbouring vertices alone, the two sides are two patches
  CHECK(stivs[0].volume == doctest::Approx(0.5 * 0.8 * -3));
  CHECK(stivs[1].volume == doctest::Approx(2 * 0.8 * -2));  // in the region of vertex 1, the heaviest
  REQUIRE(stivs[1].gradient.index == std::vector<Index>{1, 2, 3});
  CHECK(stivs[1].gradient.value[1].isApprox(Vector3(0, 0, 2 * 0.8 * 0.2 * -1)));
  const std::vector<Stiv> single = fall.volumes(ConstraintKind::single);
  REQUIRE(single.size() == 1);
  CHECK(single[0].volume == doctest::Approx(stivs[0].volume + stivs[1].volume));
}

TEST_CASE("published volumes: a vertex that flees is held to account too, as in the paper") {
  const Fall fall(-2, -1);  // the face flees down, slower than the vertex falls
  const std::vector<Stiv> stivs = fall.volumes(ConstraintKind::single);
  REQUIRE(stivs.size() == 1);
  const double remaining = 1 - fall.event.time;
  CHECK(stivs[0].volume == doctest::Approx(-remaining * (0.5 * 3 + 2 * 1)));
}

TEST_CASE("published volumes: a region keeps its earliest event") {
  const Fall fall(-3, 0);
  Event later = fall.event;
  later.time = 0.5;
  Eigen::VectorXd areas = Eigen::VectorXd::Ones(4);
  for (const Events& events : {Events{fall.event, later}, Events{later, fall.event}}) {
    const auto stivs = published_volumes(fall.surface, events, fall.start, fall.end, areas, ConstraintKind::per_patch);
    CHECK(stivs.at(0).volume == doctest::Approx(0.75 * -4));
  }
}
