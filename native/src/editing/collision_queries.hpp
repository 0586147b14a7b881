// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "detection/candidate_cache.hpp"
#include "editing/edit_context.hpp"
#include "editing/excluded_pairs.hpp"
#include "penetration/depth_watch.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/detector.hpp"

namespace stiv {

/// The collision tests of a session: continuous detection, with its cached candidates, and the exact static test.
/// Excluded pairs are left out. Caches speed up queries, and decide which events the rounds find first.
class CollisionQueries {
 public:
  /// The context must outlive the queries.
  explicit CollisionQueries(const EditContext& context);
  CollisionQueries(const CollisionQueries&) = delete;  // the cache refers to the detector
  CollisionQueries& operator=(const CollisionQueries&) = delete;

  /// The first surface that is checked is the start of the session.
  /// @throws StartIntersectsError
  void check_start(const Positions& q, Execution& execution);

  /// Events of a step, with the proximity of the rounds; nothing if the step exceeds the pair limit.
  std::optional<Events> find(const Positions& from, const Positions& to, PairLimit limit, Execution& execution);
  /// Events among the cached candidates. Updates `to.surface` at the vertices of these candidates only.
  Events find_cached(const Positions& from, State& to, Execution& execution);
  /// Prunes cached candidates that the step does not bring close. Called when rounds toward another goal begin.
  void prune_cache(const Positions& from, const Positions& to, Execution& execution);
  void clear_cache() { cache_.clear(); }

  /// Does `find` without events prove the step clear?
  bool rounds_prove_clearance() const;
  /// Earliest time of any event with the proximity of accepted states; nothing if the step exceeds the pair limit.
  std::optional<double> earliest_time(const Positions& from, const Positions& to, PairLimit limit,
                                      Execution& execution);
  /// The exact static test of a surface, given that `from` passes it. Excluded pairs may intersect, but not more of
  /// them than in `from`, and no deeper than at the start. (mathematics.md, "Excluded pairs")
  bool is_intersection_free(const Positions& from, const Positions& to, Execution& execution);
  /// Is a step free of intersections, whatever its clearance, given that its start is? For sessions without excluded
  /// pairs.
  bool is_step_free(const PositionsView& from, const PositionsView& to, Execution& execution);

 private:
  std::optional<Events> find_not_excluded(Detector& detector, const Positions& from, const Positions& to,
                                          const Proximity& proximity, PairLimit limit, Execution& execution) const;

  const EditContext& context_;
  Detector detector_;
  CandidateCache cache_;                    ///< of `detector_`
  std::optional<Detector> round_detector_;  ///< of the rounds, if they use another narrow phase; without a cache
  IntersectionTest intersections_;
  ExcludedPairs excluded_;
  std::optional<DepthWatch> depth_;  ///< of excluded pairs, if there are any
  BodySeparations no_separations_;
};

}  // namespace stiv
