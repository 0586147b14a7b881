// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cstring>

#include "detection/event_bits.hpp"
#include "detection/scenes.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/detection/distance.hpp"
#include "stiv/detection/narrow_phase.hpp"
#include "stiv/error.hpp"

using namespace stiv;

namespace {

Events find(const MovingScene& scene, BroadPhase broad_phase, int threads, double separation) {
  Execution execution(threads);
  return Detector(scene.surface, {.broad_phase = broad_phase, .large_body = 1})
      .find(scene.start, scene.end, {separation, 0.5}, execution);
}

/// A triangle with a vertex above it that falls through, and a loose edge beside it.
MovingScene falling_vertex() {
  SurfaceDefinition definition;
  definition.vertex_count = 4;
  definition.triangles.resize(1, 3);
  definition.triangles << 0, 1, 2;
  MovingScene scene;
  scene.surface = std::make_shared<const Surface>(definition);
  scene.start.resize(4, 3);
  scene.start << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.25, 0.25, 1;
  scene.end = scene.start;
  scene.end(3, 2) = -1;
  return scene;
}

}  // namespace

TEST_CASE("detector: both cuts of a flip face meet others, and never each other") {
  SurfaceDefinition definition;
  definition.vertex_count = 5;
  definition.triangles.resize(4, 3);
  definition.triangles << 0, 1, 2, 0, 2, 3, 0, 1, 3, 1, 2, 3;
  definition.flip_faces = {{0, 1, 2, 3}};
  MovingScene scene;
  scene.surface = std::make_shared<const Surface>(definition);
  scene.start.resize(5, 3);
  scene.start << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.6, 0.2, 1;
  scene.end = scene.start;
  scene.end.row(2) << 0.5, 0.5, 0.3;  // bends the square until its diagonals have passed each other
  for (const BroadPhase broad_phase : {BroadPhase::bvh, BroadPhase::hash_grid, BroadPhase::brute_force}) {
    CHECK(find(scene, broad_phase, 1, 0).empty());
    MovingScene struck = scene;
    struck.end.row(4) << 0.6, 0.2, -1;
    CHECK(find(struck, broad_phase, 1, 0).size() == 2);
  }
}

TEST_CASE("detector: bodies that move in different directions meet as brute force says, at any scale") {
  const std::vector<Vector3> displacements{{0, 0, 0}, {0.4, -0.3, -0.15}, {-0.5, 0.1, -0.3}, {0.02, 0.6, -0.4}};
  std::size_t found = 0;
  for (const auto& [seed, scale] : {std::pair(1U, 1e-7), std::pair(2U, 1.0), std::pair(3U, 1e7)}) {
    MovingScene scene = carried_sheets(12, displacements, 0.01, seed);
    scene.start *= scale;
    scene.end *= scale;
    const Events expected = find(scene, BroadPhase::brute_force, 1, 0.004 * scale);
    found += expected.size();
    for (const int threads : {1, 2, 3})
      CHECK(same_bits(find(scene, BroadPhase::bvh, threads, 0.004 * scale), expected));
    CHECK(same_bits(find(scene, BroadPhase::hash_grid, 1, 0.004 * scale), expected));
  }
  CHECK(found > 1000);
}

TEST_CASE("detector: a body that moves past others by many edges has no more candidates than one that rests") {
  const auto candidates = [](const std::vector<Vector3>& displacements) {
    const MovingScene scene = carried_sheets(20, displacements, 1e-4, 1);
    Execution execution(1);
    Detector(scene.surface, {.large_body = 1}).find(scene.start, scene.end, {1e-4, 0.5}, execution);
    return execution.counters.candidate_pairs;
  };
  const Vector3 none = Vector3::Zero(), hardly(1e-5, 0, 0), along(0.5, -0.4, 0.3), down(-0.3, 0.4, -0.3);
  CHECK(candidates({none, along}) <= candidates({none, hardly}));
  CHECK(candidates({none, none, along}) <= candidates({none, none, hardly}));
  CHECK(candidates({down, none, along}) <= candidates({hardly, none, hardly}));
}

TEST_CASE("detector: within the pair limit, a large body that moves by many edges has no step with events") {
  const Vector3 none = Vector3::Zero(), beside(0.5, 0, 0), through(0.6, 0, -0.15);
  for (const bool meets : {false, true}) {
    const MovingScene scene = carried_sheets(12, {none, meets ? through : beside}, 1e-4, 1);
    Execution execution(1);
    for (const Index large_body : {1, 1 << 14}) {
      Detector detector(scene.surface, {.large_body = large_body});
      const auto events = detector.find_within_pair_limit(scene.start, scene.end, {1e-4, 0.5}, execution);
      const auto time = detector.earliest_time_within_pair_limit(scene.start, scene.end, {1e-4, 0.5}, execution);
      const bool is_refused = meets && large_body == 1;
      CHECK(events.has_value() != is_refused);
      CHECK(time.has_value() != is_refused);
      if (events) CHECK(events->empty() != meets);
      if (time) CHECK((*time == never) != meets);
    }
  }
}

TEST_CASE("detector: prepared trees find the same events, and refuse positions of another surface") {
  const MovingScene scene = falling_vertex();
  Execution execution(1);
  Detector prepared(scene.surface);
  prepared.prepare(scene.start, {0.1, 0.5}, execution);
  CHECK(prepared.find(scene.start, scene.end, {0.1, 0.5}, execution).size() ==
        Detector(scene.surface).find(scene.start, scene.end, {0.1, 0.5}, execution).size());
  CHECK_THROWS_AS(prepared.prepare(scene.start.topRows(3), {}, execution), InputError);
}

TEST_CASE("detector: a loose vertex that falls through a face is one event") {
  const MovingScene scene = falling_vertex();
  for (const BroadPhase broad_phase : {BroadPhase::bvh, BroadPhase::hash_grid, BroadPhase::brute_force}) {
    const Events events = find(scene, broad_phase, 1, 0);
    REQUIRE(events.size() == 1);
    CHECK(events[0].kind == EventKind::vertex_face);
    CHECK(events[0].vertices == std::array<Index, 4>{3, 0, 1, 2});
    CHECK(events[0].time == doctest::Approx(0.5).epsilon(1e-12));
    CHECK(events[0].normal.isApprox(Vector3::UnitZ()));
    CHECK(events[0].start_distance == 1);
  }
}

TEST_CASE("detector: trees and grid find exactly the events of brute force, for any number of threads") {
  for (const unsigned seed : {1U, 2U, 3U})
    for (const double separation : {0.0, 0.01}) {
      const MovingScene scene = stirred_sheets(12, 3, 0.08, seed);
      const Events expected = find(scene, BroadPhase::brute_force, 1, separation);
      REQUIRE(expected.size() > 100);
      for (const int threads : {1, 2, 3}) {
        CHECK(same_bits(find(scene, BroadPhase::bvh, threads, separation), expected));
        CHECK(same_bits(find(scene, BroadPhase::hash_grid, threads, separation), expected));
      }
    }
}

TEST_CASE("detector: trees that are kept find the same as new ones") {
  const MovingScene scene = stirred_sheets(10, 3, 0.08, 4);
  const MovingScene other = stirred_sheets(10, 3, 0.3, 5);
  Execution execution(1);
  Detector detector(scene.surface);
  detector.find(other.start, other.end, {0.02, 0.5}, execution);
  const Events again = detector.find(scene.start, scene.end, {0.01, 0.5}, execution);
  CHECK(same_bits(again, find(scene, BroadPhase::bvh, 1, 0.01)));
  CHECK(execution.counters.detections == 2);
}

TEST_CASE("detector: events are sorted, share no vertex and are unique") {
  const MovingScene scene = stirred_sheets(12, 3, 0.1, 6);
  const Events events = find(scene, BroadPhase::bvh, 2, 0.01);
  for (std::size_t k = 0; k + 1 < events.size(); ++k)
    CHECK(std::pair(events[k].kind, events[k].vertices) < std::pair(events[k + 1].kind, events[k + 1].vertices));
  for (const Event& event : events) {
    std::array<Index, 4> v = event.vertices;
    std::sort(v.begin(), v.end());
    CHECK(std::adjacent_find(v.begin(), v.end()) == v.end());
  }
}

TEST_CASE("detector: the earliest time is that of the earliest event") {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const MovingScene scene = stirred_sheets(12, 3, 0.05, seed);
    double expected = never;
    for (const Event& event : find(scene, BroadPhase::brute_force, 1, 0.01)) expected = std::min(expected, event.time);
    for (const int threads : {1, 2}) {
      Execution execution(threads);
      CHECK(Detector(scene.surface).earliest_time(scene.start, scene.end, {0.01, 0.5}, execution) == expected);
    }
  }
  MovingScene still = stirred_sheets(5, 2, 0, 1);
  Execution execution(1);
  CHECK(Detector(still.surface).earliest_time(still.start, still.end, {0.01, 0.5}, execution) == never);
}

TEST_CASE("detector: common motion gives no event, and events do not change under it") {
  MovingScene scene = stirred_sheets(12, 3, 0.08, 8);
  const Vector3 shift(1.5, -2.25, 0.75);
  MovingScene carried = scene;
  carried.end = scene.start.rowwise() + shift.transpose();
  CHECK(find(carried, BroadPhase::bvh, 1, 0.05).empty());
  CHECK(find(carried, BroadPhase::hash_grid, 1, 0.05).empty());
  CHECK(find(carried, BroadPhase::brute_force, 1, 0.05).empty());

  const Events resting = find(scene, BroadPhase::bvh, 1, 0.01);
  scene.end.rowwise() += shift.transpose();
  const Events moving = find(scene, BroadPhase::bvh, 1, 0.01);
  REQUIRE(moving.size() == resting.size());
  for (std::size_t k = 0; k < moving.size(); ++k) {
    CHECK(moving[k].vertices == resting[k].vertices);
    CHECK(moving[k].time == doctest::Approx(resting[k].time).epsilon(1e-9));
  }
}

TEST_CASE("detector: pairs of which nothing moves, and bodies that do not meet, are left out") {
  MovingScene scene = stirred_sheets(8, 2, 0.2, 9);
  const Positions still = scene.end;
  Execution execution(1);
  Detector detector(scene.surface);
  CHECK(detector.find(still, still, {0.01, 0.5}, execution).empty());
  CHECK(execution.counters.candidate_pairs == 0);

  SurfaceDefinition definition;
  definition.vertex_count = scene.surface->vertex_count();
  definition.triangles = scene.surface->triangles();
  for (Index k = 0; k < definition.vertex_count; ++k) definition.vertex_body.push_back(scene.surface->body_of(k));
  definition.bodies = {{"a", Mobility::rigid}, {"b", Mobility::rigid}};
  scene.surface = std::make_shared<const Surface>(definition);
  for (const BroadPhase broad_phase : {BroadPhase::bvh, BroadPhase::hash_grid, BroadPhase::brute_force}) {
    const Events events = find(scene, broad_phase, 1, 0.01);
    CHECK(events.size() > 10);
    for (const Event& event : events)
      CHECK(scene.surface->body_of(event.vertices[0]) != scene.surface->body_of(event.vertices[3]));
  }
  definition.ignored = {{0, 1}};
  scene.surface = std::make_shared<const Surface>(definition);
  CHECK(find(scene, BroadPhase::bvh, 1, 0.01).empty());
}

TEST_CASE("detector: faces without area and edges without length meet by their vertices and edges") {
  // A face whose corners lie on a line, one whose corners coincide and one that repeats a corner; a net falls on them.
  SurfaceDefinition definition;
  definition.vertex_count = 9 + 4;
  definition.triangles.resize(5, 3);
  definition.triangles << 0, 1, 2, 3, 4, 5, 6, 7, 7, 9, 10, 11, 9, 11, 12;
  MovingScene scene;
  scene.surface = std::make_shared<const Surface>(definition);
  scene.start.resize(13, 3);
  scene.start << 0.2, 0.1, 0, 0.5, 0.1, 0, 0.8, 0.1, 0,  //
      0.5, 0.5, 0, 0.5, 0.5, 0, 0.5, 0.5, 0,             //
      0.3, 0.9, 0, 0.7, 0.9, 0, 2, 2, 2,                 //
      0, 0, 0.3, 1, 0, 0.3, 1, 1, 0.3, 0, 1, 0.3;
  scene.end = scene.start;
  scene.end.bottomRows(4).col(2).array() -= 0.6;
  for (const BroadPhase broad_phase : {BroadPhase::bvh, BroadPhase::hash_grid, BroadPhase::brute_force}) {
    std::array<bool, 13> met{};
    for (const Event& event : find(scene, broad_phase, 1, 1e-3)) {
      CHECK(event.time == doctest::Approx((0.3 - 1e-3) / 0.6).epsilon(1e-2));
      for (const Index vertex : event.vertices) met[static_cast<std::size_t>(vertex)] = true;
    }
    for (std::size_t vertex = 0; vertex < 8; ++vertex) CHECK(met[vertex]);
  }
  const Events expected = find(scene, BroadPhase::brute_force, 1, 1e-3);
  CHECK(same_bits(find(scene, BroadPhase::bvh, 1, 1e-3), expected));
  CHECK(same_bits(find(scene, BroadPhase::hash_grid, 1, 1e-3), expected));
}

TEST_CASE("detector: empty surfaces and bad input") {
  SurfaceDefinition definition;
  definition.triangles.resize(0, 3);
  const auto empty = std::make_shared<const Surface>(definition);
  Execution execution(1);
  CHECK(Detector(empty).find(Positions(0, 3), Positions(0, 3), {}, execution).empty());

  MovingScene scene = falling_vertex();
  Detector detector(scene.surface);
  CHECK_THROWS_AS(detector.find(scene.start, scene.end, {-1, 0.5}, execution), InputError);
  CHECK_THROWS_AS(detector.find(scene.start, scene.end, {0, 1}, execution), InputError);
  CHECK_THROWS_AS(detector.find(scene.start, Positions(3, 3), {}, execution), InputError);
  scene.end(2, 1) = std::nan("");
  CHECK_THROWS_WITH_AS(detector.find(scene.start, scene.end, {}, execution), doctest::Contains("vertex 2"), InputError);
}

TEST_CASE("detector: a motion with too many close pairs is reported, a fraction of it is not") {
  MovingScene scene = stirred_sheets(45, 1, 0, 10);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> far(-10, 10);
  const Positions motion = Positions::NullaryExpr(scene.start.rows(), 3, [&] { return far(random); });
  const Proximity proximity{1e-3, 0.5};
  for (const int threads : {1, 2}) {
    Execution execution(threads);
    Detector detector(scene.surface);
    CHECK_FALSE(detector.find_within_pair_limit(scene.start, scene.start + motion, proximity, execution));
    CHECK_FALSE(detector.earliest_time_within_pair_limit(scene.start, scene.start + motion, proximity, execution));
    CHECK(execution.counters.candidate_pairs == 0);
    const Positions end = scene.start + motion / 1024;
    const auto part = detector.find_within_pair_limit(scene.start, end, proximity, execution);
    REQUIRE(part);
    CHECK(same_bits(*part, Detector(scene.surface).find(scene.start, end, proximity, execution)));
    CHECK(detector.find_within_pair_limit(scene.start, end, proximity, execution)->size() > 20);
  }
}

TEST_CASE("detector: coordinates beyond single precision") {
  MovingScene scene = falling_vertex();
  scene.start *= 1e60;
  scene.end *= 1e60;
  CHECK(find(scene, BroadPhase::bvh, 1, 0).size() == 1);
  CHECK(find(scene, BroadPhase::hash_grid, 1, 0).size() == 1);
}
