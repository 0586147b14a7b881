// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/detector.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>

#include "detection/candidates.hpp"
#include "detection/pair_test.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

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

bool comes_before(const Event& a, const Event& b) {
  return std::tie(a.kind, a.vertices) < std::tie(b.kind, b.vertices);
}

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
  std::optional<Events> find(const Step& step, bool manageable, Execution& execution) {
    std::optional<std::vector<ChunkResult>> results =
        search(step, manageable, execution, [](const PairTest& test, EventKind kind) {
          return [&test, kind](const Candidate& candidate, ChunkResult& result) {
            if (auto event = test.event(kind, candidate, 1)) result.events.push_back(*event);
          };
        });
    if (!results) return std::nullopt;
    Events events;
    for (ChunkResult& result : *results) {
      events.insert(events.end(), result.events.begin(), result.events.end());
      result.events = Events();  // there may be millions
    }
    std::sort(events.begin(), events.end(), comes_before);
    execution.counters.events += static_cast<std::int64_t>(events.size());
    return events;
  }

  std::optional<double> earliest_time(const Step& step, bool manageable, Execution& execution) {
    std::atomic<double> earliest{never};
    const auto results = search(step, manageable, execution, [&](const PairTest& test, EventKind kind) {
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
  std::optional<std::vector<ChunkResult>> search(const Step& step, bool manageable, Execution& execution,
                                                 const Decide& decide) {
    check_shape(step);
    check_proximity(step.proximity);
    const FloatingPointScope floating_point;
    source_->update(step, execution);
    ++execution.counters.detections;
    if (manageable && !source_->manageable()) return std::nullopt;
    const PairTest test(*surface_, step, narrow_phase_, source_->vertex_steps());
    const Index faces = source_->chunk_count(EventKind::vertex_face);
    const Index chunks = faces + source_->chunk_count(EventKind::edge_edge);
    std::vector<ChunkResult> results(static_cast<std::size_t>(chunks));
    execution.for_chunks(chunks, 1, [&](Index chunk, Index, Index) {
      ChunkResult& result = results[static_cast<std::size_t>(chunk)];
      const EventKind kind = chunk < faces ? EventKind::vertex_face : EventKind::edge_edge;
      const auto decide_pair = decide(test, kind);
      source_->visit(kind, chunk < faces ? chunk : chunk - faces, [&](std::span<Candidate> candidates) {
        const std::span<Candidate> left = test.reduce(kind, candidates);
        result.candidates += static_cast<std::int64_t>(candidates.size());
        result.tested += static_cast<std::int64_t>(left.size());
        for (const Candidate& candidate : left) decide_pair(candidate, result);
      });
    });
    count(results, execution.counters);
    return results;
  }

  /// What the numbers are is for the source to check.
  void check_shape(const Step& step) const {
    for (const Positions* positions : {&step.start, &step.end})
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
};

Detector::Detector(std::shared_ptr<const Surface> surface, DetectorOptions options)
    : implementation_(std::make_unique<Implementation>(std::move(surface), options)) {}
Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;

Events Detector::find(const Positions& start, const Positions& end, Proximity proximity, Execution& execution) {
  return *implementation_->find({start, end, proximity}, false, execution);
}

double Detector::earliest_time(const Positions& start, const Positions& end, Proximity proximity,
                               Execution& execution) {
  return *implementation_->earliest_time({start, end, proximity}, false, execution);
}

std::optional<Events> Detector::find_if_manageable(const Positions& start, const Positions& end, Proximity proximity,
                                                   Execution& execution) {
  return implementation_->find({start, end, proximity}, true, execution);
}

std::optional<double> Detector::earliest_time_if_manageable(const Positions& start, const Positions& end,
                                                            Proximity proximity, Execution& execution) {
  return implementation_->earliest_time({start, end, proximity}, true, execution);
}

const Surface& Detector::surface() const { return implementation_->surface(); }

}  // namespace stiv
