// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "detection/pair_search.hpp"

namespace stiv {

/// Candidates that full searches of a detector found close together: a small fraction of all pairs. Rounds of an edit
/// test them first, and search all pairs only if none of these interferes. Calls may come in any order: each first adds
/// the close pairs of the last search. The content depends only on the searched steps, neither on the broad phase nor
/// on the number of threads. (mathematics.md, "The loop")
class CandidateCache {
 public:
  /// Positions of some vertices at the start and at the end of a step, (k, 3) each.
  struct Rows {
    Positions start, end;
  };
  using PlaceVertices = std::function<Rows(std::span<const Index> vertices)>;

  /// The detector must outlive the cache.
  /// @param resting the last vertices, this many, have the same positions in all steps of the detector and the cache
  explicit CandidateCache(Detector& detector, Index resting = 0) : search_(*detector.search_), resting_(resting) {
    search_.set_resting(resting);
  }

  /// The events of a step among the cached candidates. `place` gives the step of their vertices, in ascending order; it
  /// is not called if nothing is cached.
  /// @throws InputError if the rows are not as many as the vertices, or not finite
  Events find(const PlaceVertices& place, Proximity proximity, Execution& execution);

  /// Removes candidates that the step of the whole surface, (N, 3), does not bring close.
  /// @throws Interrupted with nothing changed, as `find`
  void prune(const PositionsView& start, const PositionsView& end, Proximity proximity, const Execution& execution);

  /// The earliest contact in a short step of the whole surface, (N, 3), `never` if there is none, decided by the
  /// candidates of the detector's last search. Nothing if these may miss a pair that touches: then search.
  /// @param proximity must ask no pair of bodies to keep a distance
  std::optional<double> earliest_contact(const PositionsView& start, const PositionsView& end,
                                         const Proximity& proximity, Execution& execution) {
    return search_.earliest_contact({start, end, proximity}, execution);
  }

  void clear();

  /// In ascending order.
  const std::vector<Candidate>& candidates(EventKind kind, const Execution& execution);
  const std::vector<Index>& vertices(const Execution& execution);

 private:
  void add_last_search(const Execution& execution);
  void replace(ClosePairs pairs);
  void take_resting_steps(const ClosePairs& pairs, const PositionsView& positions);
  void take_rows(const Rows& rows, const Execution& execution);

  PairSearch& search_;
  ClosePairs pairs_;
  std::vector<Index> vertices_;  ///< of all pairs, ascending
  VertexSteps steps_;
  Index resting_;
};

}  // namespace stiv
