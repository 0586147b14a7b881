// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/candidate_cache.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "detection/broad_phase/relevance.hpp"
#include "detection/broad_phase/step.hpp"
#include "detection/close_pairs.hpp"
#include "detection/primitive_pair.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr EventKind kinds[] = {EventKind::vertex_face, EventKind::edge_edge};

constexpr auto before = [](const Candidate& a, const Candidate& b) {
  return pair_key(a.first, a.second) < pair_key(b.first, b.second);
};

/// Union of sorted candidates and others, without duplicates.
std::vector<Candidate> united(const std::vector<Candidate>& sorted, std::vector<Candidate> others) {
  std::sort(others.begin(), others.end(), before);
  std::vector<Candidate> all;
  all.reserve(sorted.size() + others.size());
  std::set_union(sorted.begin(), sorted.end(), others.begin(), others.end(), std::back_inserter(all), before);
  return all;
}

/// The same for both kinds. The order of two edges depends on the order of a tree: here the lower one comes first.
ClosePairs united(const ClosePairs& sorted, ClosePairs others, const Execution& execution) {
  for (Candidate& pair : others[1])
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
  ClosePairs all;
  execution.for_chunks(2, 1, [&](Index, Index, Index number) {
    const auto kind = static_cast<std::size_t>(number);
    all[kind] = united(sorted[kind], std::move(others[kind]));
  });
  return all;
}

}  // namespace

Events CandidateCache::find(const PlaceVertices& place, Proximity proximity, Execution& execution) {
  check_proximity(proximity);
  add_last_search(execution);
  if (vertices_.empty()) return {};
  const FloatingPointScope floating_point;
  take_rows(place(vertices_), execution);
  return search_.find_among(pairs_, steps_, proximity, execution);
}

// Removes far pairs first: they are the majority, and need no sorting.
void CandidateCache::prune(const PositionsView& start, const PositionsView& end, Proximity proximity,
                           const Execution& execution) {
  search_.check_step({start, end, proximity});
  const FloatingPointScope floating_point;
  const ClosePairs searched = search_.take_close_pairs(execution);
  steps_.update_first(static_cast<Index>(start.rows()) - resting_, start, end, execution);
  take_resting_steps(pairs_, start);
  take_resting_steps(searched, start);
  const FrameMotions motions = search_.frame_motions(start, end);
  ClosePairs kept, added;
  execution.for_chunks(4, 1, [&](Index, Index, Index number) {
    const auto kind = static_cast<std::size_t>(number % 2);
    const bool cached = number < 2;
    append_close(search_.surface(), kinds[kind], (cached ? pairs_ : searched)[kind], steps_, motions,
                 proximity.separation, (cached ? kept : added)[kind]);
  });
  replace(united(kept, std::move(added), execution));
}

void CandidateCache::clear() {
  search_.drop_close_pairs();
  pairs_ = {};
  vertices_.clear();
}

const std::vector<Candidate>& CandidateCache::candidates(EventKind kind, const Execution& execution) {
  add_last_search(execution);
  return pairs_[static_cast<std::size_t>(kind)];
}

const std::vector<Index>& CandidateCache::vertices(const Execution& execution) {
  add_last_search(execution);
  return vertices_;
}

void CandidateCache::add_last_search(const Execution& execution) {
  if (search_.has_close_pairs()) replace(united(pairs_, search_.take_close_pairs(execution), execution));
}

/// The only change of the content: an interruption before it leaves the cache unchanged.
void CandidateCache::replace(ClosePairs pairs) {
  const Surface& surface = search_.surface();
  std::vector<unsigned char> listed(static_cast<std::size_t>(surface.vertex_count()), 0);
  for (std::size_t kind = 0; kind < pairs.size(); ++kind)
    for (const Candidate& pair : pairs[kind])
      for (const Index vertex : vertices_of(surface, kinds[kind], pair)) listed[vertex] = 1;
  pairs_ = std::move(pairs);
  vertices_.clear();
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (listed[vertex] != 0) vertices_.push_back(vertex);
}

/// Only of the vertices of pairs: there are far fewer than resting ones.
void CandidateCache::take_resting_steps(const ClosePairs& pairs, const PositionsView& positions) {
  const Index first = search_.surface().vertex_count() - resting_;
  for (std::size_t kind = 0; resting_ > 0 && kind < pairs.size(); ++kind)
    for (const Candidate& pair : pairs[kind])
      for (const Index vertex : vertices_of(search_.surface(), kinds[kind], pair))
        if (vertex >= first) steps_.update_one(vertex, positions);
}

void CandidateCache::take_rows(const Rows& rows, const Execution& execution) {
  constexpr Index rows_per_chunk = 1024;
  const auto count = static_cast<Index>(vertices_.size());
  for (const Positions* positions : {&rows.start, &rows.end})
    if (positions->rows() != count)
      throw InputError("the cached candidates have " + std::to_string(count) + " vertices, not " +
                       std::to_string(positions->rows()));
  execution.for_chunks(count, rows_per_chunk, [&](Index begin, Index end, Index) {
    for (const Positions* positions : {&rows.start, &rows.end})
      for (Index row = begin; row < end; ++row) search_.surface().check_position(vertices_[row], positions->row(row));
  });
  steps_.update_rows(rows.start, rows.end, vertices_, search_.surface().vertex_count(), execution);
}

}  // namespace stiv
