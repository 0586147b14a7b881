// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>

#include "detection/candidate_cache.hpp"
#include "detection/event_bits.hpp"
#include "detection/scenes.hpp"
#include "position_rows.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/error.hpp"

using namespace stiv;

namespace {

constexpr Proximity proximity{0.004, 0.5};

Events found_by(Detector& detector, const Positions& start, const Positions& end, int threads) {
  Execution execution(threads);
  return detector.find(start, end, proximity, execution);
}

/// A detector with a cache.
struct CachedSearch {
  Detector detector;
  CandidateCache cache{detector};

  explicit CachedSearch(const MovingScene& scene, BroadPhase broad_phase = BroadPhase::bvh)
      : detector(scene.surface, {.broad_phase = broad_phase, .large_body = 1}) {}

  Events cached(const Positions& start, const Positions& end, int threads = 1) {
    Execution execution(threads);
    const auto place = [&](std::span<const Index> vertices) {
      return CandidateCache::Rows{rows_of(start, vertices), rows_of(end, vertices)};
    };
    return cache.find(place, proximity, execution);
  }
};

Events expected(const MovingScene& scene, const Positions& start, const Positions& end) {
  Detector detector(scene.surface, {.broad_phase = BroadPhase::brute_force});
  return found_by(detector, start, end, 1);
}

/// Ends of rounds of an edit: back toward the start, more or less to the side, moved along, and with other vertices
/// moving.
std::vector<Positions> ends_of_rounds(const MovingScene& scene, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const Positions motion = scene.end - scene.start;
  std::vector<Positions> ends;
  for (const double back : {0.9, 0.5, 0.0}) ends.push_back(scene.start + back * motion);
  Positions each = scene.end;
  for (Index vertex = 0; vertex < each.rows(); ++vertex)
    each.row(vertex) = scene.start.row(vertex) + unit(random) * motion.row(vertex);
  ends.push_back(each);
  for (const double aside : {0.0002, 0.001, 0.5})
    ends.push_back(scene.end + aside * Positions(motion.rowwise().reverse()));
  ends.push_back(scene.end.rowwise() + Eigen::RowVector3d(0.3, -0.2, 0.1));
  Positions part = scene.end;
  part.bottomRows(part.rows() / 3) = scene.start.bottomRows(part.rows() / 3);
  ends.push_back(part);
  part.row(part.rows() - 1) += Eigen::RowVector3d(0, 0, -0.2);
  ends.push_back(part);
  return ends;
}

void compare_rounds(const MovingScene& scene, unsigned seed) {
  std::mt19937 random(seed);
  Detector one(scene.surface, {.large_body = 1}), two(scene.surface, {.large_body = 1});
  found_by(one, scene.start, scene.end, 1);
  found_by(two, scene.start, scene.end, 2);
  for (const Positions& end : ends_of_rounds(scene, random)) {
    const Events events = expected(scene, scene.start, end);
    CHECK(same_bits(found_by(one, scene.start, end, 1), events));
    CHECK(same_bits(found_by(two, scene.start, end, 2), events));
  }
}

bool same_pair(const Event& a, const Event& b) { return a.kind == b.kind && a.vertices == b.vertices; }

const Event* event_of_pair(const Events& events, const Event& wanted) {
  const auto found =
      std::find_if(events.begin(), events.end(), [&](const Event& event) { return same_pair(event, wanted); });
  return found == events.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("rounds: a detector with cached pairs finds exactly the events of one that tests all pairs") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    MovingScene scene = stirred_sheets(9, 3, 0.06, seed);
    compare_rounds(scene, seed);
    scene.end.topRows(81) = scene.start.topRows(81);  // one sheet rests
    compare_rounds(scene, seed);
    scene.end.bottomRows(162).rowwise() += Eigen::RowVector3d(0.02, 0.01, -0.9);  // the others fall through it
    compare_rounds(scene, seed);
    compare_rounds(carried_sheets(9, {{0, 0, 0}, {0.5, 0, -0.15}, {-0.3, 0.4, -0.3}}, 0.02, seed), seed);
  }
}

TEST_CASE("rounds: cached events are those of a whole search among the cached pairs, whatever came before") {
  std::size_t found = 0, missed = 0;
  for (const MovingScene& scene :
       {stirred_sheets(9, 3, 0.06, 4), carried_sheets(9, {{0, 0, 0}, {0.5, 0, -0.15}, {-0.3, 0.4, -0.3}}, 0.02, 4)}) {
    std::mt19937 random(4);
    CachedSearch trees(scene), grid(scene, BroadPhase::hash_grid);
    for (const Positions& first : ends_of_rounds(scene, random)) {
      CachedSearch fresh(scene);
      trees.cache.clear();
      grid.cache.clear();
      const Events before = found_by(trees.detector, scene.start, first, 1);
      found_by(fresh.detector, scene.start, first, 2);
      found_by(grid.detector, scene.start, first, 1);
      for (const Positions& end : ends_of_rounds(scene, random)) {
        const Events cached = trees.cached(scene.start, end);
        CHECK(same_bits(cached, fresh.cached(scene.start, end, 2)));
        CHECK(same_bits(cached, grid.cached(scene.start, end)));
        const Events all = expected(scene, scene.start, end);
        for (const Event& event : cached) {
          const Event* const same = event_of_pair(all, event);
          REQUIRE(same != nullptr);
          CHECK(same_bits({event}, {*same}));
        }
        for (const Event& event : all)
          if (event_of_pair(before, event) != nullptr) CHECK(event_of_pair(cached, event) != nullptr);
        found += cached.size();
        missed += all.size() - cached.size();
      }
    }
  }
  CHECK(found > 100);
  CHECK(missed > 0);
}

TEST_CASE("rounds: the pairs of several searches stay cached, each once, until a step prunes them") {
  const MovingScene scene = stirred_sheets(9, 3, 0.06, 4);
  std::mt19937 random(11);
  const std::vector<Positions> ends = ends_of_rounds(scene, random);
  CachedSearch trees(scene), grid(scene, BroadPhase::hash_grid);
  std::vector<Events> of_searches;
  for (const Positions& end : ends) {
    of_searches.push_back(found_by(trees.detector, scene.start, end, 1));
    found_by(grid.detector, scene.start, end, 2);
    for (std::size_t k = 0; k < of_searches.size(); ++k) {  // no pair is lost or repeated
      CHECK(same_bits(trees.cached(scene.start, ends[k]), of_searches[k]));
      CHECK(same_bits(grid.cached(scene.start, ends[k]), of_searches[k]));
    }
  }
  const Positions& last = ends.front();  // a fraction of the path: closer than most others
  for (CachedSearch* const some : {&trees, &grid}) some->cache.prune(scene.start, last, proximity, Execution(1));
  CHECK(same_bits(trees.cached(scene.start, last), of_searches.front()));
  std::size_t left = 0, all = 0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const Events events = trees.cached(scene.start, ends[k]);
    CHECK(same_bits(events, grid.cached(scene.start, ends[k])));
    left += events.size();
    all += of_searches[k].size();
  }
  CHECK(left > 0);
  CHECK(left < all);
}

TEST_CASE("rounds: nothing is cached before the first search, or after clearing") {
  const MovingScene scene = stirred_sheets(9, 3, 0.06, 4);
  const Execution execution(1);
  CachedSearch search(scene);
  CHECK(search.cache.vertices(execution).empty());
  CHECK(search.cached(scene.start, scene.end).empty());
  for (const bool asked : {false, true}) {
    CHECK(found_by(search.detector, scene.start, scene.end, 1).size() > 10);
    if (asked) CHECK(search.cached(scene.start, scene.end).size() > 10);
    search.cache.clear();
    CHECK(search.cache.vertices(execution).empty());
    CHECK(search.cached(scene.start, scene.end).empty());
  }
}

TEST_CASE("rounds: rows of cached vertices that are too few or not finite are refused by name") {
  const MovingScene scene = stirred_sheets(9, 3, 0.06, 4);
  Execution execution(1);
  CachedSearch search(scene);
  found_by(search.detector, scene.start, scene.end, 1);
  const std::vector<Index> vertices = search.cache.vertices(execution);
  REQUIRE(vertices.size() > 3);
  CandidateCache::Rows rows{rows_of(scene.start, vertices), rows_of(scene.end, vertices)};
  const auto find = [&] { search.cache.find([&](std::span<const Index>) { return rows; }, proximity, execution); };
  rows.end(3, 1) = never;
  const std::string name = scene.surface->describe_vertex(vertices[3]) + ": coordinate is not finite";
  CHECK_THROWS_WITH_AS(find(), name.c_str(), InputError);
  CHECK_THROWS_AS(search.cache.prune(scene.start, rows.end, proximity, execution), InputError);
  rows.end = Positions(rows.end.topRows(2));
  CHECK_THROWS_AS(find(), InputError);
}

TEST_CASE("rounds: consecutive edits, each from the end of the previous one, with static parts") {
  MovingScene scene = stirred_sheets(10, 3, 0, 5);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> noise(-0.03, 0.03);
  std::uniform_int_distribution<Index> some(0, 290);
  Detector detector(scene.surface);
  for (int edit = 0; edit < 12; ++edit) {
    Positions end = scene.start;
    const Index first = some(random);
    for (Index vertex = first; vertex < first + 10; ++vertex)
      for (Index axis = 0; axis < 3; ++axis) end(vertex, axis) += noise(random);
    for (const double part : {1.0, 0.8}) {
      const Positions to = scene.start + part * (end - scene.start);
      CHECK(same_bits(found_by(detector, scene.start, to, 1 + edit % 2), expected(scene, scene.start, to)));
    }
    scene.start = end;
  }
}

TEST_CASE("rounds: what was cancelled at any point leaves no trace") {
  const MovingScene scene = stirred_sheets(30, 3, 0.01, 8);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> noise(-0.01, 0.01);
  for (const int threads : {1, 2}) {
    Detector detector(scene.surface);
    int cancelled = 0;
    bool done = false;
    for (int checks = 0; !done; checks += 1 + checks / 16) {
      Positions start = scene.start, end = start;
      if (cancelled % 3 > 0) found_by(detector, start, start, 1);  // from its own start, or in the middle of an edit
      const Index first = cancelled % 2 == 0 ? 0 : 1800;
      for (Index vertex = first; vertex < end.rows(); ++vertex) end(vertex, 2) += noise(random);
      Execution hurried(threads);
      std::atomic<int> left{checks};
      hurried.cancel_when([&] { return left.fetch_sub(1) <= 0; });
      try {
        detector.find(start, end, proximity, hurried);
        done = true;
      } catch (const Interrupted&) {
        ++cancelled;
      }
      end(cancelled, 2) += 0.01;  // the same step except for one vertex
      Detector fresh(scene.surface);
      CHECK(same_bits(found_by(detector, start, end, 1), found_by(fresh, start, end, 1)));
    }
    CHECK(cancelled > 30);
  }
}

TEST_CASE("rounds: pairs are looked at again only where the step is another") {
  const MovingScene scene = stirred_sheets(24, 3, 0.05, 7);
  Detector detector(scene.surface);
  found_by(detector, scene.start, scene.end, 1);
  Execution same(1), local(1);
  detector.find(scene.start, scene.start + 0.9 * (scene.end - scene.start), proximity, same);
  Positions end = scene.start;
  end.row(30) += Eigen::RowVector3d(0, 0, 0.12);  // through the next sheet
  detector.find(scene.start, end, proximity, local);
  CHECK(same.counters.candidate_pairs > 1000);
  CHECK(local.counters.candidate_pairs > 0);
  CHECK(local.counters.candidate_pairs < same.counters.candidate_pairs / 20);
}
