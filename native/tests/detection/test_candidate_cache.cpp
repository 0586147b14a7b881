// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/candidate_cache.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "detection/broad_phase/relevance.hpp"
#include "detection/scenes.hpp"

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
