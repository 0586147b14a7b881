// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "detection/pair_search.hpp"

namespace stiv {

/// Candidates that searches of a detector brought close: few of all pairs, and those that meet next where a response
/// pushes back. Rounds of an edit ask these first; what they miss, a whole search finds. The content depends on the
/// searched steps alone, not on the broad phase or the number of threads.
class CandidateCache {
 public:
  /// Positions of some vertices at the start and at the end of a step, (k, 3) each.
  struct Rows {
    Positions start, end;
  };
  using PlaceVertices = std::function<Rows(std::span<const Index> vertices)>;

  /// The detector must outlive the cache.
  explicit CandidateCache(Detector& detector) : search_(*detector.search_) {}

  /// The events of a step among the cached candidates. `place` is asked for the step of their vertices, in ascending
  /// order; not at all where nothing is cached.
  /// @throws InputError if the rows are not as many as the vertices, or not finite
  Events find(const PlaceVertices& place, Proximity proximity, Execution& execution);

  /// Prunes candidates that the step of the whole surface, (N, 3), does not bring close. Called when a new edit begins.
  /// @throws Interrupted with nothing changed, as `find`
  void prune(const PositionsView& start, const PositionsView& end, Proximity proximity, const Execution& execution);

  void clear();

  /// In ascending order, of what has been searched up to now.
  const std::vector<Candidate>& candidates(EventKind kind, const Execution& execution);
  const std::vector<Index>& vertices(const Execution& execution);

 private:
  void add_last_search(const Execution& execution);
  void replace(ClosePairs pairs);
  void take_rows(const Rows& rows);

  PairSearch& search_;
  ClosePairs pairs_;
  std::vector<Index> vertices_;  ///< of all pairs, ascending
  VertexSteps steps_;
};

}  // namespace stiv
