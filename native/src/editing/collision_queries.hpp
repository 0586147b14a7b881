// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "detection/candidate_cache.hpp"
#include "editing/edit_context.hpp"
#include "editing/excluded_pairs.hpp"
#include "penetration/depth_watch.hpp"
#include "penetration/overlap_watch.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/detector.hpp"

namespace stiv {

/// Whether a candidate has the rows of its surface that a query reads.
enum class CandidateRows { placed, to_be_placed };

/// The collision tests of a session: continuous detection, with its cached candidates, and the exact static test.
/// Excluded pairs are left out. Caches speed up queries, and decide which events the rounds find first. Positions are
/// given without those of obstacles.
class CollisionQueries {
 public:
  /// The context must outlive the queries.
  /// @param start controls of the session's start, at which excluded pairs are examined
  CollisionQueries(const EditContext& context, const Controls& start, Execution& execution);
  CollisionQueries(const CollisionQueries&) = delete;
  CollisionQueries& operator=(const CollisionQueries&) = delete;

  /// The first surface that is checked is the start of the session. Builds the trees from it, so that the first edit
  /// need not.
  /// @throws StartIntersectsError
  void check_start(const Positions& surface, Execution& execution);

  /// Events of a step, with the proximity of the rounds; nothing if the step exceeds the pair limit.
  std::optional<Events> find(const Positions& from, const Positions& to, PairLimit limit, Execution& execution);
  /// Events among the cached candidates. `to.surface` needs to be that of `to.controls` at their vertices only, where
  /// it is placed unless it is already.
  Events find_cached(const Positions& from, State& to, CandidateRows rows, Execution& execution);
  /// Prunes cached candidates that the step does not bring close. Called when rounds toward another goal begin.
  void prune_cache(const Positions& from, const Positions& to, Execution& execution);
  void clear_cache() { guard_->cache.clear(); }
  /// The pairs of triangles that may intersect, see ExcludedPairs.
  const IndexPairs& excluded() const { return excluded_.pairs(); }
  /// A step with the obstacles, valid until the next query. With obstacles, other rows than those of vertices of the
  /// events are undefined, unless volumes need them.
  std::pair<const Positions&, const Positions&> at_events(const Events& events, const Positions& from,
                                                          const Positions& to);

  /// Does `find` without events prove the step clear?
  bool rounds_prove_clearance() const;
  /// Earliest time of any event with the proximity of accepted states; nothing if the step exceeds the pair limit.
  std::optional<double> earliest_time(const Positions& from, const Positions& to, PairLimit limit,
                                      Execution& execution);
  /// The exact static test of a surface, given that `from` passes it: 1 if it passes, otherwise a smaller fraction of
  /// the step to try next, or 0. Excluded pairs may intersect, but not more of them than in `from`, as
  /// ExcludedPairs::are_more, and no deeper than at the start. (mathematics.md, "Excluded pairs", "Overlapping bodies")
  double free_fraction(const Positions& from, const Positions& to, Execution& execution);
  /// Is a step free of intersections, whatever its clearance, given that its start is? For sessions without excluded
  /// pairs.
  bool is_step_free(const PositionsView& from, const PositionsView& to, Execution& execution);
  /// The test of surfaces that deviate by rounding from the accepted one; null if it was not the last that passed the
  /// static test, for excluded pairs, bodies that may overlap, and obstacles.
  std::shared_ptr<const DeviationTest> deviation_test(const PositionsView& accepted) const;

 private:
  /// The tests of a surface without the pairs of bodies that overlap now.
  struct Guard {
    Guard(std::shared_ptr<const Surface> guarded, const EditContext& context);
    Guard(const Guard&) = delete;  // the cache refers to the detector
    Guard& operator=(const Guard&) = delete;

    std::shared_ptr<const Surface> surface;
    Detector detector;
    CandidateCache cache;                    ///< of `detector`
    std::optional<Detector> round_detector;  ///< of the rounds, if they use another narrow phase; without a cache
    IntersectionTest intersections;
  };

  struct Intersecting {
    Positions surface;
    IntersectionCount count;
  };

  void prepare_searches(const Positions& surface, Execution& execution);
  void guard_pairs_apart_at(const Positions& accepted, Execution& execution);
  bool is_end_free(const PositionsView& from, const PositionsView& to, Execution& execution);
  bool passes_static_test(const Positions& from, const Positions& to, Execution& execution);
  const IntersectionCount& intersecting_at(const Positions& accepted, Execution& execution);
  std::optional<Events> find_not_excluded(Detector& detector, const Positions& from, const Positions& to,
                                          const Proximity& proximity, PairLimit limit, Execution& execution) const;

  void place_rows(std::span<const Index> vertices, State& state, const Execution& execution) const;
  Positions centred_rows(const Positions& q, std::span<const Index> vertices, const Execution& execution) const;
  std::vector<unsigned char> moved(const PositionsView& from, const PositionsView& to,
                                   const Execution& execution) const;

  const EditContext& context_;
  SceneRows start_, end_, centred_start_, centred_end_;  // of the last query
  std::unique_ptr<Guard> guard_;
  ExcludedPairs excluded_;
  std::optional<DepthWatch> depth_;      ///< of excluded pairs, if there are any
  std::optional<OverlapWatch> overlap_;  ///< of bodies that may overlap, if there are any
  std::vector<unsigned char> overlapping_;
  Positions guarded_at_;  ///< the accepted surface at which `overlapping_` holds
  BodySeparations no_separations_;
  Intersecting intersecting_;  ///< excluded pairs, of the surface that passed the static test last
};

}  // namespace stiv
