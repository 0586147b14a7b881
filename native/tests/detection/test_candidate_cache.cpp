// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/candidate_cache.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <span>

#include "detection/broad_phase/relevance.hpp"
#include "detection/scenes.hpp"
#include "position_rows.hpp"

using namespace stiv;

namespace {

constexpr Proximity proximity{0.004, 0.5};
const EventKind kinds[] = {EventKind::vertex_face, EventKind::edge_edge};

bool is_before(const Candidate& a, const Candidate& b) {
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

std::set<std::array<Index, 4>> cached_pairs(const Surface& surface, CandidateCache& cache) {
  std::set<std::array<Index, 4>> pairs;
  for (const EventKind kind : kinds)
    for (const Candidate& pair : cache.candidates(kind, Execution(1))) pairs.insert(vertices_of(surface, kind, pair));
  return pairs;
}

std::map<std::array<Index, 4>, double> times_of(const Events& events) {
  std::map<std::array<Index, 4>, double> times;
  for (const Event& event : events) times[event.vertices] = event.time;
  return times;
}

/// A surface in which each coordinate differs by up to `reach`.
Positions shaken(const Positions& surface, double reach, std::mt19937& random) {
  std::uniform_real_distribution<double> noise(-reach, reach);
  return surface.unaryExpr([&](double x) { return x + noise(random); });
}

/// A step in which all vertices move, largely together.
MovingScene scaled_sheets(double stir, unsigned seed, double scale) {
  MovingScene scene = stirred_sheets(7, 3, stir, seed);
  scene.end.rowwise() += Eigen::RowVector3d(2, -1, 0.5);
  scene.start *= scale;
  scene.end *= scale;
  return scene;
}

/// Contacts count, and no distance.
struct Touching {
  BodySeparations none{3, 0};
  Proximity proximity;

  explicit Touching(double separation) { proximity = {.separation = separation, .by_bodies = &none}; }
};

}  // namespace

TEST_CASE("candidate cache: each pair once, in ascending order, the lower of two edges first, with all vertices") {
  const MovingScene scene = stirred_sheets(9, 3, 0.06, 3);
  const Surface& surface = *scene.surface;
  for (const BroadPhase broad_phase : {BroadPhase::bvh, BroadPhase::hash_grid, BroadPhase::brute_force}) {
    Detector detector(scene.surface, {.broad_phase = broad_phase});
    CandidateCache cache(detector);
    Execution execution(1);
    for (const double fraction : {1.0, 0.7, 1.2}) {
      detector.find(scene.start, scene.start + fraction * (scene.end - scene.start), proximity, execution);
      std::set<Index> vertices;
      for (const EventKind kind : kinds) {
        const std::vector<Candidate>& pairs = cache.candidates(kind, execution);
        CHECK(pairs.size() > 20);
        CHECK(std::adjacent_find(pairs.begin(), pairs.end(), [](const Candidate& a, const Candidate& b) {
                return !is_before(a, b);
              }) == pairs.end());
        for (const Candidate& pair : pairs) {
          if (kind == EventKind::edge_edge) CHECK(pair.first < pair.second);
          for (const Index vertex : vertices_of(surface, kind, pair)) vertices.insert(vertex);
        }
      }
      CHECK(cache.vertices(execution) == std::vector<Index>(vertices.begin(), vertices.end()));
    }
  }
}

TEST_CASE("candidate cache: pruning leaves the pairs that meet during the step, and few others") {
  const MovingScene scene = stirred_sheets(9, 3, 0.06, 3);
  Detector detector(scene.surface), oracle(scene.surface, {.broad_phase = BroadPhase::brute_force});
  CandidateCache cache(detector);
  Execution execution(1);
  detector.find(scene.start, scene.end, proximity, execution);
  detector.find(scene.start, scene.start + 3 * (scene.end - scene.start), proximity, execution);
  const std::set<std::array<Index, 4>> before = cached_pairs(*scene.surface, cache);
  cache.prune(scene.start, scene.end, proximity, execution);
  const std::set<std::array<Index, 4>> after = cached_pairs(*scene.surface, cache);
  CHECK(after.size() < before.size() / 2);
  std::size_t met = 0;
  for (const Event& event : oracle.find(scene.start, scene.end, proximity, execution)) {
    met += before.count(event.vertices);
    CHECK(after.count(event.vertices) == before.count(event.vertices));
  }
  CHECK(met > 20);
}

TEST_CASE("candidate cache: resting vertices, prepared elsewhere or not, change no events and no candidates") {
  bool is_prepared = false;
  SUBCASE("prepared") { is_prepared = true; }
  SUBCASE("not prepared") {}
  constexpr Index size = 9, resting = size * size;
  const MovingScene scene = stirred_sheets(size, 3, 0.06, 3);
  const Positions rest = scene.start.bottomRows(resting);
  Detector detector(scene.surface), other(scene.surface);
  CandidateCache cache(detector, resting), expected(other);
  Execution execution(2);
  if (is_prepared) {
    Positions elsewhere = scene.start.array() + 0.01;
    elsewhere.bottomRows(resting) = rest;
    detector.prepare(elsewhere, proximity, execution);
    cache.prune(elsewhere, elsewhere, proximity, execution);
    CHECK(cached_pairs(*scene.surface, cache).empty());
  }
  std::size_t events = 0;
  for (const double fraction : {1.0, 0.3, 1.5, -0.5, 1.0}) {
    Positions end = scene.start + fraction * (scene.end - scene.start);
    end.bottomRows(resting) = rest;
    const auto place = [&](std::span<const Index> vertices) {
      return CandidateCache::Rows{rows_of(scene.start, vertices), rows_of(end, vertices)};
    };
    CHECK(times_of(cache.find(place, proximity, execution)) == times_of(expected.find(place, proximity, execution)));
    const Events found = detector.find(scene.start, end, proximity, execution);
    CHECK(times_of(found) == times_of(other.find(scene.start, end, proximity, execution)));
    cache.prune(scene.start, end, proximity, execution);
    expected.prune(scene.start, end, proximity, execution);
    CHECK(cached_pairs(*scene.surface, cache) == cached_pairs(*scene.surface, expected));
    events += found.size();
  }
  CHECK(events > 100);
}

TEST_CASE("candidate cache: short steps from either end of a search have the contacts of a new detector") {
  int touching = 0, clear = 0;
  for (const double scale : {1e-7, 1.0, 1e7})
    for (unsigned seed = 0; seed < 9; ++seed) {
      const double separation = (seed % 3 == 0 ? 0.02 : 0.4) * scale, reach = 0.999 * separation / 8;
      const MovingScene scene = scaled_sheets(seed % 2 == 0 ? 0.002 : 0.05, seed, scale);
      const Touching touch(separation);
      std::mt19937 random(seed);
      Detector detector(scene.surface);
      CandidateCache cache(detector);
      Execution execution(2);
      detector.find(scene.start, scene.end, {separation}, execution);
      for (const Positions* place : {&scene.start, &scene.end, &scene.start})
        for (int step = 0; step < 4; ++step) {
          const double length = step % 2 == 0 ? reach : reach / 50;
          const Positions from = shaken(*place, length, random), to = shaken(*place, length, random);
          Detector fresh(scene.surface);
          const std::optional<double> found = cache.earliest_contact(from, to, touch.proximity, execution);
          REQUIRE(found.has_value());
          CHECK(*found == fresh.earliest_time(from, to, touch.proximity, execution));
          ++(*found == never ? clear : touching);
        }
    }
  CHECK(touching > 50);
  CHECK(clear > 50);
}

TEST_CASE("candidate cache: steps that the last search does not cover are not decided") {
  const MovingScene scene = scaled_sheets(0.05, 1, 1);
  const Touching touch(0.1);
  Execution execution(1);
  const auto decides = [&](CandidateCache& cache, const Positions& from, const Positions& to) {
    return cache.earliest_contact(from, to, touch.proximity, execution).has_value();
  };
  Detector detector(scene.surface), grid(scene.surface, {.broad_phase = BroadPhase::hash_grid});
  CandidateCache cache(detector), of_grid(grid);
  CHECK_FALSE(decides(cache, scene.start, scene.start));  // there was no search
  Positions searched = scene.end;
  searched.row(5) = scene.start.row(5);  // at rest
  detector.find(scene.start, searched, {0.1}, execution);
  grid.find(scene.start, searched, {0.1}, execution);
  Positions near = scene.start;
  near(8, 1) += 0.0124;
  CHECK(decides(cache, scene.start, near));
  CHECK(decides(cache, near, scene.start));
  CHECK_FALSE(decides(of_grid, scene.start, near));
  near(8, 1) = scene.start(8, 1) + 0.0126;
  CHECK_FALSE(decides(cache, scene.start, near));  // too far
  CHECK_FALSE(decides(cache, near, scene.start));
  CHECK_FALSE(decides(cache, scene.start, searched));  // each end is near one of the searched step
  near = scene.start;
  near(5, 2) += 1e-9;
  CHECK_FALSE(decides(cache, scene.start, near));  // pairs of vertices at rest were not searched
  near(5, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(decides(cache, scene.start, near));
  detector.find(scene.start, searched, {0}, execution);
  CHECK_FALSE(decides(cache, scene.start, scene.start));  // pairs nearby were not searched
}

TEST_CASE("candidate cache: after a short step it holds what a search of that step would leave") {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const MovingScene scene = scaled_sheets(0.05, seed, 1);
    const Touching touch(0.1);
    std::mt19937 random(seed);
    const Positions from = shaken(scene.end, 0.01, random), to = shaken(scene.end, 0.01, random);
    Detector detector(scene.surface), oracle(scene.surface);
    CandidateCache cache(detector), expected(oracle);
    Execution execution(1);
    detector.find(scene.start, scene.end, {0.1}, execution);
    oracle.find(scene.start, scene.end, {0.1}, execution);
    REQUIRE(cache.earliest_contact(from, to, touch.proximity, execution).has_value());
    oracle.earliest_time(from, to, touch.proximity, execution);
    const bool is_pruned = seed % 2 == 0;
    if (is_pruned) cache.prune(from, scene.start, {0.1}, execution);
    if (is_pruned) expected.prune(from, scene.start, {0.1}, execution);
    CHECK(cached_pairs(*scene.surface, cache) == cached_pairs(*scene.surface, expected));
    CHECK(cached_pairs(*scene.surface, cache).size() > 10);
    detector.find(from, scene.start, {0.1}, execution);
    REQUIRE(cache.earliest_contact(from, from, touch.proximity, execution).has_value());
    const Events events = detector.find(to, scene.start, {0.1}, execution);
    CHECK(events.size() == Detector(scene.surface).find(to, scene.start, {0.1}, execution).size());
    cache.clear();
    CHECK(cached_pairs(*scene.surface, cache).empty());
  }
}
