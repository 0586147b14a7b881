// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "stiv/volumes/relative.hpp"

using namespace stiv;

namespace {

/// A vertex falling obliquely onto a triangle that stays parallel to itself: the contact plane keeps its normal, so the
/// volume of the paper, A (1 - t) n . Drho, can be evaluated for any end positions from its definition.
struct FallingVertex {
  Positions start = Positions(4, 3), end = Positions(4, 3);
  double separation = 0.01;

  FallingVertex() {
    start << 0.3, 0.25, 0.5, 0, 0, 0, 1, 0, 0.1, 0, 1, 0.2;
    end = start;
    end.row(0) += Eigen::RowVector3d(0.2, 0.1, -0.9);
    for (int k = 1; k < 4; ++k) end.row(k) += Eigen::RowVector3d(0.1, -0.05, 0.1);
  }

  Vector3 normal() const {
    const Vector3 a = start.row(1), b = start.row(2), c = start.row(3);
    return (b - a).cross(c - a).normalized();
  }
};

/// The event at the time when the vertex is `distance` above the moving plane.
Event solve_event(const FallingVertex& scene, const Positions& end, double distance) {
  Event event;
  event.vertices = {0, 1, 2, 3};
  event.normal = scene.normal();
  const Vector3 gap = (scene.start.row(0) - scene.start.row(1)).transpose();
  const Vector3 approach = (end.row(0) - end.row(1)).transpose() - gap;
  event.time = (distance - event.normal.dot(gap)) / event.normal.dot(approach);
  const Positions at = scene.start + event.time * (end - scene.start);
  Eigen::Matrix3d corners;
  for (int k = 0; k < 3; ++k) corners.col(k) = at.row(k + 1).transpose();
  const Vector3 foot = at.row(0).transpose() - distance * event.normal;
  const Vector3 bary = corners.inverse() * foot;
  event.weights = {1, -bary[0], -bary[1], -bary[2]};
  event.start_distance = event.normal.dot(gap);
  event.clearance = {scene.separation, scene.separation / 2};
  return event;
}

/// A (1 - t) n . Drho for the vertex, with the plane offset by the response's target. [P3, Eq. 3]
double volume_by_definition(const FallingVertex& scene, const Positions& end, double area) {
  const Event event = solve_event(scene, end, 2 * scene.separation);
  return area * (1 - event.time) * event.normal.dot(weighted_sum(event, Positions(end - scene.start)));
}

Stiv volume_of(const FallingVertex& scene, const std::vector<Region>& regions, const Eigen::VectorXd& areas) {
  const Events events{solve_event(scene, scene.end, scene.separation)};
  const std::vector<Index> labels(regions.size(), 0);
  return interference_volumes(events, regions, labels, scene.end, areas).at(0);
}

}  // namespace

TEST_CASE("stiv: volume and gradient are those of the definition, by finite differences") {
  const FallingVertex scene;
  const double area = 0.37;
  const Stiv stiv = volume_of(scene, {{0, 0}}, Eigen::VectorXd::Constant(4, area));
  CHECK(stiv.volume == doctest::Approx(volume_by_definition(scene, scene.end, area)).epsilon(1e-12));
  CHECK(stiv.volume < 0);
  REQUIRE(stiv.gradient.index == std::vector<Index>{0, 1, 2, 3});
  const double step = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    Positions forward = scene.end, backward = scene.end;
    forward(0, axis) += step;
    backward(0, axis) -= step;
    const double slope =
        (volume_by_definition(scene, forward, area) - volume_by_definition(scene, backward, area)) / (2 * step);
    CHECK(stiv.gradient.value[0][axis] == doctest::Approx(slope).epsilon(1e-8));
    forward = backward = scene.end;  // the triangle moved as one: the sum of its corners' gradients
    forward.bottomRows(3).col(axis).array() += step;
    backward.bottomRows(3).col(axis).array() -= step;
    const double slope_of_face =
        (volume_by_definition(scene, forward, area) - volume_by_definition(scene, backward, area)) / (2 * step);
    const Vector3 face = stiv.gradient.value[1] + stiv.gradient.value[2] + stiv.gradient.value[3];
    CHECK(face[axis] == doctest::Approx(slope_of_face).epsilon(1e-8));
  }
}

TEST_CASE("stiv: a patch is the area-weighted sum of its regions, without a net force") {
  const FallingVertex scene;
  Eigen::VectorXd areas(4);
  areas << 0.3, 0.2, 0.5, 0.1;
  const Stiv both = volume_of(scene, {{0, 0}, {1, 0}}, areas);
  const Stiv one = volume_of(scene, {{0, 0}}, areas);
  CHECK(both.volume == doctest::Approx(one.volume / 0.3 * 0.5));
  Vector3 sum = Vector3::Zero();
  for (const Vector3& value : both.gradient.value) sum += value;
  CHECK(sum.norm() < 1e-15);
}

TEST_CASE("stiv: a common motion changes neither volume nor gradient") {
  FallingVertex scene;
  const Eigen::VectorXd areas = Eigen::VectorXd::Ones(4);
  const Events events{solve_event(scene, scene.end, scene.separation)};
  const auto at_rest = interference_volumes(events, {{0, 0}}, {0}, scene.end, areas);
  const Positions carried = scene.end.rowwise() + Eigen::RowVector3d(8, -4, 16);
  const auto moving = interference_volumes(events, {{0, 0}}, {0}, carried, areas);
  CHECK(moving[0].volume == doctest::Approx(at_rest[0].volume).epsilon(1e-12));
  CHECK(moving[0].gradient.value == at_rest[0].gradient.value);
}

TEST_CASE("stiv: a pair that slides on after contact counts a thousandth of its target") {
  FallingVertex scene;
  Events events{solve_event(scene, scene.end, scene.separation)};
  scene.end.row(0) = scene.start.row(0);  // ends clear of the frozen plane
  const auto stivs = interference_volumes(events, {{0, 0}}, {0}, scene.end, Eigen::VectorXd::Ones(4));
  CHECK(stivs[0].volume == doctest::Approx(-1e-3 * 0.02));
}

TEST_CASE("stiv: a pair that starts within the separation is not pushed away, others slightly beyond it") {
  const FallingVertex scene;
  Events events{solve_event(scene, scene.end, scene.separation)};
  const auto volume = [&](double start_distance) {
    events[0].start_distance = start_distance;
    events[0].clearance = Proximity{scene.separation, 0.5}.clearance(start_distance);
    return interference_volumes(events, {{0, 0}}, {0}, scene.end, Eigen::VectorXd::Ones(4))[0].volume;
  };
  CHECK(volume(1) - volume(0.005) == doctest::Approx(0.005 - 0.02));
  CHECK(volume(1) - volume(0.018) == doctest::Approx(0.018 - 0.02));
  CHECK(volume(1) - volume(0.0101) == doctest::Approx(0.015 - 0.02));
}

TEST_CASE("stiv: a separation large relative to mesh and motion causes no rebound") {
  const FallingVertex scene;
  Events events{solve_event(scene, scene.end, scene.separation)};
  const double at_end = events[0].normal.dot(weighted_sum(events[0], scene.end));
  const auto target = [&](double separation, double area) {
    events[0].start_distance = separation;
    events[0].clearance = Proximity{separation, 0.5}.clearance(separation);
    return at_end -
           interference_volumes(events, {{0, 0}}, {0}, scene.end, Eigen::VectorXd::Constant(4, area))[0].volume / area;
  };
  const double depth = 10 - at_end;
  CHECK(target(10, 1e-4) == doctest::Approx(10 + 0.1 * depth));           // a tenth of the violation
  CHECK(target(at_end + 2, 400) == doctest::Approx(at_end + 2.4));        // 0.02 of the region's size
  CHECK(target(at_end + 1, 400) == doctest::Approx(1.5 * (at_end + 1)));  // half of the separation at most
}

TEST_CASE("stiv: vertices without area have the mean area of the others") {
  SurfaceDefinition definition;
  definition.vertex_count = 5;
  definition.triangles.resize(1, 3);
  definition.triangles << 0, 1, 2;
  definition.loose_edges.resize(1, 2);
  definition.loose_edges << 3, 4;
  Positions q = Positions::Zero(5, 3);
  q(1, 0) = q(2, 1) = 3;
  const Eigen::VectorXd areas = region_areas(Surface(definition), q);
  for (const double area : areas) CHECK(area == doctest::Approx(1.5));
  SurfaceDefinition points;
  points.vertex_count = 2;
  CHECK(region_areas(Surface(points), Positions::Zero(2, 3)) == Eigen::VectorXd::Ones(2));
}
