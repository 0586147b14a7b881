// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/kept_pairs.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "detection/broad_phase/common_motion.hpp"
#include "detection/broad_phase/relevance.hpp"
#include "detection/scenes.hpp"

using namespace stiv;

namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

const EventKind kinds[] = {EventKind::vertex_face, EventKind::edge_edge};

Pairs kept_in(const KeptPairs& kept, EventKind kind) {
  Pairs pairs;
  for (const Candidate& pair : kept.of(kind)) pairs.emplace_back(pair.first, pair.second);
  return pairs;
}

}  // namespace

TEST_CASE("kept pairs: each once and in ascending order, two edges whichever comes first, with all their vertices") {
  const MovingScene scene = stirred_sheets(5, 2, 0.1, 3);
  const Surface& surface = *scene.surface;
  KeptPairs kept;
  kept.add(surface, {{{}, {{7, 3}, {2, 9}, {3, 4}}}}, Execution(1));
  kept.add(surface, {{{}, {{9, 2}, {3, 7}, {1, 60}}}}, Execution(1));
  CHECK(kept_in(kept, EventKind::edge_edge) == Pairs{{1, 60}, {2, 9}, {3, 4}, {3, 7}});
  CHECK(kept.of(EventKind::vertex_face).empty());
  kept.add(surface, {{{{7, 3}, {3, 7}}, {}}}, Execution(1));  // another vertex, another face
  CHECK(kept_in(kept, EventKind::vertex_face) == Pairs{{3, 7}, {7, 3}});
  kept.add(surface, {}, Execution(1));
  CHECK(kept.of(EventKind::vertex_face).size() == 2);
  std::set<Index> vertices{3, 7};
  for (const Index edge : {1, 2, 3, 4, 7, 9, 60}) vertices.insert({surface.edges()(edge, 0), surface.edges()(edge, 1)});
  for (const Index face : {3, 7})
    for (Index corner = 0; corner < 3; ++corner) vertices.insert(surface.triangles()(face, corner));
  CHECK(kept.vertices() == std::vector<Index>(vertices.begin(), vertices.end()));
}

TEST_CASE("kept pairs: of all pairs, a step leaves those that meet on its way, and few others") {
  const MovingScene scene = stirred_sheets(5, 2, 0.1, 3);
  const auto count = [](const auto& rows) { return static_cast<Index>(rows.rows()); };
  KeptPairs kept;
  std::vector<Candidate> faces, edges;
  for (Index vertex = 0; vertex < scene.surface->vertex_count(); ++vertex)
    for (Index face = 0; face < count(scene.surface->triangles()); ++face) faces.push_back({vertex, face});
  for (Index first = 0; first < count(scene.surface->edges()); ++first)
    for (Index second = first + 1; second < count(scene.surface->edges()); ++second) edges.push_back({first, second});
  constexpr double separation = 0.004;
  VertexSteps steps;
  steps.update(scene.start, scene.end, Execution(1));
  // Half of them are there before, half come.
  const auto half = [](const std::vector<Candidate>& pairs, bool second) {
    const auto middle = pairs.begin() + static_cast<std::ptrdiff_t>(pairs.size() / 2);
    return second ? std::vector<Candidate>(middle, pairs.end()) : std::vector<Candidate>(pairs.begin(), middle);
  };
  kept.add(*scene.surface, {half(faces, false), half(edges, true)}, Execution(1));
  kept.add_and_leave_close(*scene.surface, {half(faces, true), half(edges, false)}, steps,
                           common_motion(scene.start, scene.end), separation, Execution(1));
  CHECK(kept.of(EventKind::vertex_face).size() < faces.size() / 8);
  CHECK(kept.of(EventKind::edge_edge).size() < edges.size() / 8);
  Detector all(scene.surface, {.broad_phase = BroadPhase::brute_force});
  Execution execution(1);
  std::set<std::array<Index, 4>> left;
  for (const EventKind kind : kinds)
    for (const Candidate& pair : kept.of(kind)) left.insert(vertices_of(*scene.surface, kind, pair));
  const Events events = all.find(scene.start, scene.end, {separation, 0.5}, execution);
  CHECK(events.size() > 20);
  for (const Event& event : events) CHECK(left.count(event.vertices) == 1);
}
