// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/pair_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>

#include "detection/broad_phase/step.hpp"
#include "detection/close_pairs.hpp"
#include "detection/primitive_pair.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

void lower(std::atomic<double>& minimum, double value) {
  double seen = minimum.load(std::memory_order_relaxed);
  while (value < seen && !minimum.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

/// Sort key of an event, by kind and vertices; cheaper to move than the event.
struct EventOrder {
  std::array<std::uint64_t, 3> key;
  const Event* event;

  explicit EventOrder(const Event& of)
      : key{static_cast<std::uint64_t>(of.kind), pair_key(of.vertices[0], of.vertices[1]),
            pair_key(of.vertices[2], of.vertices[3])},
        event(&of) {}
  bool operator<(const EventOrder& other) const { return key < other.key; }
};

/// The chunks of both kinds of candidates, numbered consecutively.
struct ChunkRange {
  Index faces;  ///< chunks of vertex-face candidates
  Index all;

  EventKind kind(Index chunk) const { return chunk < faces ? EventKind::vertex_face : EventKind::edge_edge; }
  Index within_kind(Index chunk) const { return chunk < faces ? chunk : chunk - faces; }
};

ChunkRange chunks_of(const CandidateSource& source) {
  const Index faces = source.chunk_count(EventKind::vertex_face);
  return {faces, faces + source.chunk_count(EventKind::edge_edge)};
}

constexpr auto append_event = [](const PairTest& test, EventKind kind) {
  return [&test, kind](const Candidate& candidate, auto& result) {
    if (auto event = test.event(kind, candidate, 1)) result.events.push_back(*event);
  };
};

/// Whether a step is refused if it has events.
bool must_be_free(const Step& step, PairLimit limit) { return limit == PairLimit::respected && step.motions.go_far; }

/// Lowers `earliest` to the time of each event.
auto lower_to(std::atomic<double>& earliest) {
  return [&earliest](const PairTest& test, EventKind kind) {
    return [&test, &earliest, kind](const Candidate& candidate, auto&) {
      const double latest = std::min(1.0, earliest.load(std::memory_order_relaxed));
      if (latest == 0) return;
      if (const auto event = test.event(kind, candidate, latest)) lower(earliest, event->time);
    };
  };
}

}  // namespace

void check_proximity(const Proximity& proximity) {
  if (!(proximity.separation >= 0) || !std::isfinite(proximity.separation))
    throw InputError("separation must be finite and not negative, not " + std::to_string(proximity.separation));
  if (proximity.min_clearance_ratio <= 0 || proximity.min_clearance_ratio >= 1 ||
      std::isnan(proximity.min_clearance_ratio))
    throw InputError("min_clearance_ratio must lie between 0 and 1, not " +
                     std::to_string(proximity.min_clearance_ratio));
}

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

PairSearch::PairSearch(std::shared_ptr<const Surface> surface, DetectorOptions options)
    : surface_(std::move(surface)),
      narrow_phase_(options.narrow_phase),
      frames_(*surface_, options.large_body),
      source_(make_source(options.broad_phase, *surface_)) {}

std::optional<Events> PairSearch::find(const Step& given, PairLimit limit, Execution& execution) {
  const Step step = in_frames(given);
  std::optional<std::vector<ChunkResult>> results = search(step, limit, execution, append_event);
  if (!results) return std::nullopt;
  Events events = collect(*results, execution);
  if (must_be_free(step, limit) && !events.empty()) return std::nullopt;
  return events;
}

std::optional<double> PairSearch::earliest_time(const Step& given, PairLimit limit, Execution& execution) {
  const Step step = in_frames(given);
  std::atomic<double> earliest{never};
  if (!search(step, limit, execution, lower_to(earliest))) return std::nullopt;
  if (must_be_free(step, limit) && earliest.load() < never) return std::nullopt;
  return earliest.load();
}

std::optional<double> PairSearch::earliest_contact(const Step& step, Execution& execution) {
  check_step(step);
  const FloatingPointScope floating_point;
  if (!source_->take_short_step(step.start, step.end, execution)) return std::nullopt;
  drop_close_pairs();
  unsearched_ = step.proximity.separation;
  std::atomic<double> earliest{never};
  decide_candidates(step.proximity, execution, lower_to(earliest));
  return earliest.load();
}

Events PairSearch::find_among(const ClosePairs& pairs, const VertexSteps& steps, const Proximity& proximity,
                              Execution& execution) const {
  const FloatingPointScope floating_point;
  const PairTest test(*surface_, steps, proximity, narrow_phase_);
  constexpr Index size = 1024;
  const auto chunk_count = [&](std::size_t kind) {
    return Execution::chunk_count(static_cast<Index>(pairs[kind].size()), size);
  };
  const ChunkRange chunks{chunk_count(0), chunk_count(0) + chunk_count(1)};
  std::vector<ChunkResult> results(chunks.all);
  execution.for_chunks(chunks.all, 1, [&](Index chunk, Index, Index) {
    const EventKind kind = chunks.kind(chunk);
    const std::vector<Candidate>& of_kind = pairs[static_cast<std::size_t>(kind)];
    const Index begin = chunks.within_kind(chunk) * size,
                end = std::min(begin + size, static_cast<Index>(of_kind.size()));
    std::vector<Candidate> some(of_kind.begin() + begin, of_kind.begin() + end);
    decide_all(test, kind, some, append_event(test, kind), results[chunk]);
  });
  count(results, execution.counters);
  return collect(results, execution);
}

/// Searches the step of `source_` for its close pairs only. They are seldom wanted: an edit mostly ends with a short
/// step.
void PairSearch::search_again(const Execution& execution) {
  const FloatingPointScope floating_point;
  const VertexStep* const rows = source_->vertex_steps().data();
  Positions start(surface_->vertex_count(), 3), end(surface_->vertex_count(), 3);
  for (Index vertex = 0; vertex < surface_->vertex_count(); ++vertex) {
    start.row(vertex) = Eigen::Map<const Eigen::RowVector3d>(rows[vertex].start);
    end.row(vertex) = Eigen::Map<const Eigen::RowVector3d>(rows[vertex].end);
  }
  const Step step = in_frames({start, end, {*unsearched_}});
  source_->update(step, execution);
  if (source_->is_within_pair_limit()) last_ = WholeSearch{step.motions, step.proximity.separation};
  unsearched_.reset();
}

ClosePairs PairSearch::take_close_pairs(const Execution& execution) {
  if (unsearched_) search_again(execution);
  if (!last_) return {};
  const ChunkRange chunks = chunks_of(*source_);
  std::vector<std::vector<Candidate>> found(chunks.all);
  execution.for_chunks(chunks.all, 1, [&](Index chunk, Index, Index) {
    const EventKind kind = chunks.kind(chunk);
    const auto append_some = [&](std::span<Candidate> some) {
      append_close(*surface_, kind, some, source_->vertex_steps(), last_->motions, last_->separation, found[chunk]);
    };
    source_->visit(kind, chunks.within_kind(chunk), std::ref(append_some));
  });
  last_.reset();
  const std::span<const std::vector<Candidate>> all(found);
  return {concatenate(all.first(chunks.faces)), concatenate(all.subspan(chunks.faces))};
}

// The coordinates are checked by the source.
void PairSearch::check_step(const Step& step) const {
  check_proximity(step.proximity);
  for (const PositionsView* positions : {&step.start, &step.end})
    if (positions->rows() != surface_->vertex_count()) surface_->check_positions(*positions);
}

Step PairSearch::in_frames(const Step& step) const {
  check_step(step);
  const FloatingPointScope floating_point;
  return {step.start, step.end, step.proximity, frames_.choose(step.start, step.end)};
}

/// Calls `decide(test, kind)(candidate, result)` for every candidate that needs the narrow phase.
template <class Decide>
std::optional<std::vector<PairSearch::ChunkResult>> PairSearch::search(const Step& step, PairLimit limit,
                                                                       Execution& execution, const Decide& decide) {
  const FloatingPointScope floating_point;
  drop_close_pairs();
  source_->update(step, execution);
  ++execution.counters.detections;
  if (limit == PairLimit::respected && !source_->is_within_pair_limit()) return std::nullopt;
  std::vector<ChunkResult> results = decide_candidates(step.proximity, execution, decide);
  if (source_->is_within_pair_limit()) last_ = WholeSearch{step.motions, step.proximity.separation};
  return results;
}

template <class Decide>
std::vector<PairSearch::ChunkResult> PairSearch::decide_candidates(const Proximity& proximity, Execution& execution,
                                                                   const Decide& decide) const {
  const PairTest test(*surface_, source_->vertex_steps(), proximity, narrow_phase_);
  const ChunkRange chunks = chunks_of(*source_);
  std::vector<ChunkResult> results(chunks.all);
  execution.for_chunks(chunks.all, 1, [&](Index chunk, Index, Index) {
    ChunkResult& result = results[chunk];
    const EventKind kind = chunks.kind(chunk);
    const auto decide_pair = decide(test, kind);
    const auto decide_some = [&](std::span<Candidate> some) { decide_all(test, kind, some, decide_pair, result); };
    source_->visit(kind, chunks.within_kind(chunk), std::ref(decide_some));
  });
  count(results, execution.counters);
  return results;
}

template <class Decide>
void PairSearch::decide_all(const PairTest& test, EventKind kind, std::span<Candidate> candidates, const Decide& decide,
                            ChunkResult& result) {
  const std::span<Candidate> left = test.reduce(kind, candidates);
  result.candidates += static_cast<std::int64_t>(candidates.size());
  result.tested += static_cast<std::int64_t>(left.size());
  for (const Candidate& candidate : left) decide(candidate, result);
}

Events PairSearch::collect(const std::vector<ChunkResult>& results, Execution& execution) {
  std::vector<EventOrder> order;
  for (const ChunkResult& result : results)
    for (const Event& event : result.events) order.emplace_back(event);
  std::sort(order.begin(), order.end());
  Events events;
  events.reserve(order.size());
  for (const EventOrder& next : order) events.push_back(*next.event);
  execution.counters.events += static_cast<std::int64_t>(events.size());
  return events;
}

void PairSearch::count(const std::vector<ChunkResult>& results, Counters& counters) {
  for (const ChunkResult& result : results) {
    counters.candidate_pairs += result.candidates;
    counters.pairs_tested += result.tested;
  }
}

}  // namespace stiv
