// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "detection/candidate_cache.hpp"
#include "editing/effective_separation.hpp"
#include "editing/excluded_pairs.hpp"
#include "penetration/depth_watch.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/deformation/deformation.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/editing/options.hpp"
#include "stiv/execution.hpp"
#include "stiv/response/resolver.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Controls and the surface that they give, in world coordinates.
struct State {
  Controls controls;
  Positions surface;
};

/// From where rounds project. [P3.2; mathematics.md, "The loop and its guarantee"]
enum class Projection {
  from_goal,       ///< with all constraints kept, from the goal again; after some rounds as below
  from_last_round  ///< with those of the round alone, from where the last one came to: Algorithm 1
};

/// Where the rounds of a sub-edit stand, so that one that the time budget ended can be taken up again.
struct RoundProgress {
  Controls accepted, goal;  ///< of the sub-edit
  Projection projection = Projection::from_goal;
  ConstraintSet kept;
  Controls p;  ///< next candidate, before it is rounded
  bool accumulate = true;
  int round = 0;
  bool begun = false;                          ///< the cached candidates are pruned to this goal's path
  std::optional<Events> found = std::nullopt;  ///< on the way to the candidate, and not yet responded to
  bool constrained = false;                    ///< their constraints are among those kept
};

/// 1/2 |a - b|^2 of two surfaces. (mathematics.md, Eq. 4)
double energy(const Positions& a, const Positions& b);

/// What all edits of a session have in common: validated input, what was made of it once, and the questions that the
/// loop asks. It holds no accepted state.
class Problem {
 public:
  /// @throws InputError for shapes and values that do not fit
  Problem(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
          const Controls& controls, EditOptions options);
  Problem(const Problem&) = delete;  // proximities point into it
  Problem& operator=(const Problem&) = delete;

  const Surface& surface() const { return *surface_; }
  const std::shared_ptr<const Surface>& shared_surface() const { return surface_; }
  const Deformation& deformation() const { return *deformation_; }
  const Metric& metric() const { return *metric_; }
  const EditOptions& options() const { return options_; }
  /// Rotation vectors that are interpolated as rotations.
  const std::vector<Index>& rotation_rows() const { return rotation_rows_; }
  Proximity proximity() const { return proximity_; }
  /// That of the rounds, which aim for no distance where volumes are as published and none is asked for.
  Proximity proximity_of_rounds() const { return proximity_of_rounds_; }
  /// Does a round without events prove that the way is free?
  bool rounds_prove_path() const {
    return !round_detector_ && proximity_of_rounds_.separation == proximity_.separation;
  }
  double diagonal() const { return diagonal_; }
  bool is_empty() const { return deformation_->control_count() == 0 || surface_->vertex_count() == 0; }

  /// @throws InputError naming object and control if shape or values do not fit; `what` is "controls" or "goal"
  void check_controls(const Controls& controls, const char* what) const;
  /// The first one that is checked is the start of the session.
  /// @throws StartIntersectsError
  void check_start(const Positions& q, Execution& execution);

  /// Rounds begun and not ended by an acceptance; the session forgets them unless the time budget ended the call.
  std::optional<RoundProgress>& unfinished_rounds() { return unfinished_rounds_; }

  Controls stored(const Controls& controls) const;
  Positions surface_at(const Controls& controls, Execution& execution) const;

  /// Events on the way from one surface to the other, and the earliest time of any. Nothing if the way is too far to
  /// be searched within the pair limit.
  std::optional<Events> find_events(const Positions& from, const Positions& to, PairLimit limit, Execution& execution);
  /// Events among the cached candidates: perhaps not all events, and none if nothing is cached. Updates `to.surface` at
  /// the vertices of these candidates only.
  Events find_cached_events(const Positions& from, State& to, Execution& execution);
  /// Prunes cached candidates far from the path. Called when rounds toward another goal begin.
  void prune_cached_candidates(const Positions& from, const Positions& to, Execution& execution);
  void clear_cached_candidates() { candidate_cache_.clear(); }
  std::optional<double> earliest_time(const Positions& from, const Positions& to, PairLimit limit,
                                      Execution& execution);
  /// Exact static test; `from` is known to be free. Excluded pairs may intersect, but no more of them than in `from`,
  /// and no deeper than at the start of the session.
  bool is_free(const Positions& from, const Positions& to, Execution& execution);
  /// Is a step free, its path and its end, however near things come? Its start is known to be; nothing is excluded.
  bool is_step_free(const PositionsView& from, const PositionsView& to, Execution& execution);

 private:
  void set_proximity(const MovingExtent& extent, double least);
  /// All but those of excluded pairs.
  std::optional<Events> remaining_events(Detector& detector, const Positions& start, const Positions& end,
                                         Proximity proximity, PairLimit limit, Execution& execution) const;
  Positions centred(const PositionsView& q) const;

  std::shared_ptr<const Surface> surface_;
  std::shared_ptr<const Deformation> deformation_;
  EditOptions options_;
  std::vector<Index> rotation_rows_;
  std::unique_ptr<Metric> metric_;
  Detector detector_;
  CandidateCache candidate_cache_;
  std::optional<Detector> round_detector_;  ///< of the rounds, where it is another one
  IntersectionTest intersections_;
  ExcludedPairs excluded_;
  std::optional<DepthWatch> depth_;  ///< of excluded pairs, if there are any
  Eigen::RowVector3d centre_ = Eigen::RowVector3d::Zero();
  double diagonal_ = 0;
  std::optional<BodySeparations> body_separations_;
  BodySeparations no_separations_;
  Positions reference_;  ///< the surface at the start of the session, centred
  Proximity proximity_, proximity_of_rounds_;
  std::optional<RoundProgress> unfinished_rounds_;
};

}  // namespace stiv
