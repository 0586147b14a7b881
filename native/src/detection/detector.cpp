// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/detector.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>

#include "detection/broad_phase/candidates.hpp"
#include "detection/broad_phase/common_motion.hpp"
#include "detection/broad_phase/relevance.hpp"
#include "detection/close_pairs.hpp"
#include "detection/joined.hpp"
#include "detection/kept_pairs.hpp"
#include "detection/narrow_phase/pair_test.hpp"
#include "detection/pair_key.hpp"
#include "position_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// Which pairs a search looks at.
enum class Extent {
  all,
  manageable  ///< all, or none if they are too many
};

/// What is needed of a search to tell its close pairs.
struct WholeSearch {
  Vector3 motion;
  double separation = 0;
};

std::size_t at(Index index) { return static_cast<std::size_t>(index); }

/// What one chunk found.
struct ChunkResult {
  Events events;
  std::int64_t candidates = 0;
  std::int64_t tested = 0;
};

void check_proximity(const Proximity& proximity) {
  if (!(proximity.separation >= 0) || !std::isfinite(proximity.separation))
    throw InputError("separation must be finite and not negative, not " + std::to_string(proximity.separation));
  if (!(proximity.keep > 0 && proximity.keep < 1))
    throw InputError("the kept fraction of a start distance must lie between 0 and 1, not " +
                     std::to_string(proximity.keep));
}

void lower(std::atomic<double>& minimum, double value) {
  double seen = minimum.load(std::memory_order_relaxed);
  while (value < seen && !minimum.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

/// An event's place in the order by kind and vertices: less to move about than the event.
struct Place {
  std::array<std::uint64_t, 3> key;
  const Event* event;

  explicit Place(const Event& at)
      : key{static_cast<std::uint64_t>(at.kind), pair_key(at.vertices[0], at.vertices[1]),
            pair_key(at.vertices[2], at.vertices[3])},
        event(&at) {}
  bool operator<(const Place& other) const { return key < other.key; }
};

}  // namespace

std::unique_ptr<CandidateSource> make_source(BroadPhase broad_phase, const Surface& surface) {
  switch (broad_phase) {
    case BroadPhase::bvh:
      return make_bvh_source(surface);
    case BroadPhase::hash_grid:
      return make_hash_grid(surface);
    case BroadPhase::brute_force:
      return make_brute_force(surface);
  }
  throw InputError("there is no such broad phase");
}

class Detector::Implementation {
 public:
  Implementation(std::shared_ptr<const Surface> surface, DetectorOptions options)
      : surface_(std::move(surface)),
        narrow_phase_(options.narrow_phase),
        source_(make_source(options.broad_phase, *surface_)) {}

  /// Nothing if the step is not `manageable` though asked to be.
  std::optional<Events> find(const Step& step, Extent extent, Execution& execution) {
    std::optional<std::vector<ChunkResult>> results = search(step, extent, execution, all_events);
    if (!results) return std::nullopt;
    return collected(*results, execution);
  }

  const std::vector<Index>& kept_vertices(const Execution& execution) {
    if (last_) kept_.add(*surface_, last_close(execution), execution);
    return kept_.vertices();
  }

  Events find_among_kept(const Step& rows, Execution& execution) {
    const FloatingPointScope floating_point;
    take_kept(rows, execution);
    const PairTest test(*surface_, kept_steps_, rows.proximity, narrow_phase_);
    constexpr Index size = 1024;
    const auto chunks_of = [&](EventKind kind) {
      return Execution::chunk_count(static_cast<Index>(kept_.of(kind).size()), size);
    };
    const Index faces = chunks_of(EventKind::vertex_face), chunks = faces + chunks_of(EventKind::edge_edge);
    std::vector<ChunkResult> results(static_cast<std::size_t>(chunks));
    execution.for_chunks(chunks, 1, [&](Index chunk, Index, Index) {
      const EventKind kind = chunk < faces ? EventKind::vertex_face : EventKind::edge_edge;
      const std::vector<Candidate>& pairs = kept_.of(kind);
      const Index begin = (chunk < faces ? chunk : chunk - faces) * size,
                  end = std::min(begin + size, static_cast<Index>(pairs.size()));
      std::vector<Candidate> some(pairs.begin() + begin, pairs.begin() + end);
      decide_all(test, kind, some, all_events(test, kind), results[static_cast<std::size_t>(chunk)]);
    });
    count(results, execution.counters);
    return collected(results, execution);
  }

  void leave_kept(const Step& step, const Execution& execution) {
    check_step(step);
    const FloatingPointScope floating_point;
    kept_steps_.update(step.start, step.end, execution);
    kept_.add_and_leave_close(*surface_, last_close(execution), kept_steps_, common_motion(step.start, step.end),
                              step.proximity.separation, execution);
  }

  void forget_kept() {
    last_.reset();
    kept_ = {};
  }

  std::optional<double> earliest_time(const Step& step, Extent extent, Execution& execution) {
    std::atomic<double> earliest{never};
    const auto results = search(step, extent, execution, [&](const PairTest& test, EventKind kind) {
      return [&test, &earliest, kind](const Candidate& candidate, ChunkResult&) {
        const double latest = std::min(1.0, earliest.load(std::memory_order_relaxed));
        if (latest == 0) return;
        if (const auto event = test.event(kind, candidate, latest)) lower(earliest, event->time);
      };
    });
    if (!results) return std::nullopt;
    return earliest.load();
  }

  const Surface& surface() const { return *surface_; }

 private:
  /// Calls `decide(test, kind)(candidate, result)` for every candidate that needs the narrow phase.
  template <class Decide>
  std::optional<std::vector<ChunkResult>> search(const Step& given, Extent extent, Execution& execution,
                                                 const Decide& decide) {
    check_step(given);
    const FloatingPointScope floating_point;
    const Step step{given.start, given.end, given.proximity, common_motion(given.start, given.end)};
    last_.reset();
    source_->update(step, execution);
    ++execution.counters.detections;
    if (extent == Extent::manageable && !source_->manageable()) return std::nullopt;
    const PairTest test(*surface_, source_->vertex_steps(), step.proximity, narrow_phase_);
    const Index faces = source_->chunk_count(EventKind::vertex_face);
    const Index chunks = faces + source_->chunk_count(EventKind::edge_edge);
    std::vector<ChunkResult> results(static_cast<std::size_t>(chunks));
    execution.for_chunks(chunks, 1, [&](Index chunk, Index, Index) {
      ChunkResult& result = results[static_cast<std::size_t>(chunk)];
      const EventKind kind = chunk < faces ? EventKind::vertex_face : EventKind::edge_edge;
      const auto decide_pair = decide(test, kind);
      const auto decide_some = [&](std::span<Candidate> some) { decide_all(test, kind, some, decide_pair, result); };
      source_->visit(kind, chunk < faces ? chunk : chunk - faces, std::ref(decide_some));
    });
    count(results, execution.counters);
    if (source_->manageable()) last_ = WholeSearch{step.motion, step.proximity.separation};
    return results;
  }

  /// Calls `decide` for those that need the narrow phase.
  template <class Decide>
  static void decide_all(const PairTest& test, EventKind kind, std::span<Candidate> candidates, const Decide& decide,
                         ChunkResult& result) {
    const std::span<Candidate> left = test.reduce(kind, candidates);
    result.candidates += static_cast<std::int64_t>(candidates.size());
    result.tested += static_cast<std::int64_t>(left.size());
    for (const Candidate& candidate : left) decide(candidate, result);
  }

  static constexpr auto all_events = [](const PairTest& test, EventKind kind) {
    return [&test, kind](const Candidate& candidate, ChunkResult& result) {
      if (auto event = test.event(kind, candidate, 1)) result.events.push_back(*event);
    };
  };

  static Events collected(const std::vector<ChunkResult>& results, Execution& execution) {
    std::vector<Place> places;
    for (const ChunkResult& result : results)
      for (const Event& event : result.events) places.emplace_back(event);
    std::sort(places.begin(), places.end());
    Events events;
    events.reserve(places.size());
    for (const Place& place : places) events.push_back(*place.event);
    execution.counters.events += static_cast<std::int64_t>(events.size());
    return events;
  }

  /// The close pairs of the last search, if they have not been asked for: from what the source still holds of it.
  ClosePairs last_close(const Execution& execution) {
    if (!last_) return {};
    const Index faces = source_->chunk_count(EventKind::vertex_face);
    const Index chunks = faces + source_->chunk_count(EventKind::edge_edge);
    std::vector<std::vector<Candidate>> parts(static_cast<std::size_t>(chunks));
    execution.for_chunks(chunks, 1, [&](Index chunk, Index, Index) {
      const EventKind kind = chunk < faces ? EventKind::vertex_face : EventKind::edge_edge;
      std::vector<Candidate>& part = parts[static_cast<std::size_t>(chunk)];
      const auto append_some = [&](std::span<Candidate> some) {
        append_close(*surface_, kind, some, source_->vertex_steps(), last_->motion, last_->separation, part);
      };
      source_->visit(kind, chunk < faces ? chunk : chunk - faces, std::ref(append_some));
    });
    last_.reset();
    const std::span<const std::vector<Candidate>> all(parts);
    return {joined(all.first(at(faces))), joined(all.subspan(at(faces)))};
  }

  /// Takes a step of the kept vertices.
  void take_kept(const Step& rows, const Execution& execution) {
    check_proximity(rows.proximity);
    const std::vector<Index>& vertices = kept_vertices(execution);
    for (const PositionsView* positions : {&rows.start, &rows.end}) {
      if (positions->rows() != static_cast<Index>(vertices.size()))
        throw InputError("there are " + std::to_string(vertices.size()) + " vertices of kept pairs, and positions of " +
                         std::to_string(positions->rows()) + ": give one row for each");
      for (Index row = 0; row < positions->rows(); ++row)
        surface_->check_position(vertices[at(row)], positions->row(row));
    }
    kept_steps_.update_rows(rows.start, rows.end, vertices, surface_->vertex_count());
  }

  /// What the numbers are is for the source to check.
  void check_step(const Step& step) const {
    check_proximity(step.proximity);
    for (const PositionsView* positions : {&step.start, &step.end})
      if (positions->rows() != surface_->vertex_count()) surface_->check_positions(*positions);
  }

  static void count(const std::vector<ChunkResult>& results, Counters& counters) {
    for (const ChunkResult& result : results) {
      counters.candidate_pairs += result.candidates;
      counters.pairs_tested += result.tested;
    }
  }

  std::shared_ptr<const Surface> surface_;
  NarrowPhase narrow_phase_;
  std::unique_ptr<CandidateSource> source_;
  std::optional<WholeSearch> last_;  ///< if it was complete and manageable, and none of its pairs are kept yet
  KeptPairs kept_;
  VertexSteps kept_steps_;  ///< of their vertices
};

Detector::Detector(std::shared_ptr<const Surface> surface, DetectorOptions options)
    : implementation_(std::make_unique<Implementation>(std::move(surface), options)) {}
Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;

Events Detector::find(const PositionsView& start, const PositionsView& end, Proximity proximity, Execution& execution) {
  return *implementation_->find({start, end, proximity}, Extent::all, execution);
}

double Detector::earliest_time(const PositionsView& start, const PositionsView& end, Proximity proximity,
                               Execution& execution) {
  return *implementation_->earliest_time({start, end, proximity}, Extent::all, execution);
}

std::optional<Events> Detector::find_if_manageable(const PositionsView& start, const PositionsView& end,
                                                   Proximity proximity, Execution& execution) {
  return implementation_->find({start, end, proximity}, Extent::manageable, execution);
}

std::optional<double> Detector::earliest_time_if_manageable(const PositionsView& start, const PositionsView& end,
                                                            Proximity proximity, Execution& execution) {
  return implementation_->earliest_time({start, end, proximity}, Extent::manageable, execution);
}

const std::vector<Index>& Detector::kept_vertices(const Execution& execution) {
  return implementation_->kept_vertices(execution);
}

Events Detector::find_among_kept(const PositionsView& start, const PositionsView& end, Proximity proximity,
                                 Execution& execution) {
  return implementation_->find_among_kept({start, end, proximity}, execution);
}

void Detector::leave_kept(const PositionsView& start, const PositionsView& end, Proximity proximity,
                          const Execution& execution) {
  implementation_->leave_kept({start, end, proximity}, execution);
}

void Detector::forget_kept() { implementation_->forget_kept(); }

const Surface& Detector::surface() const { return implementation_->surface(); }

}  // namespace stiv
