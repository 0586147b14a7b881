// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "editing/edit_call.hpp"

namespace stiv {

using StatePredicate = std::function<bool(const State&)>;

/// The result of the rounds of one sub-edit.
struct RoundOutcome {
  State candidate;       ///< controls as stored, and their surface
  bool clear = false;    ///< detection found no event on the step from the accepted state to the candidate
  bool too_far = false;  ///< the step exceeds the pair limit: no round was made
  PairLimit pair_limit = PairLimit::respected;  ///< of the searches of these rounds
  bool given_up = false;                        ///< `is_diverging` was true
  bool is_cut = false;  ///< the step to the candidate was shortened to where the deformation has a surface
  Events events;        ///< of the last round that had any
  Index patches = 0;
};

/// Where rounds search first. Toward a goal that something keeps far away, the beginning of the step suffices: its end
/// may lie so deep in the obstacle that a whole side of a large body has events.
enum class FirstSearch { whole_step, near_start };

/// The inner loop of an edit: rounds of detection and response, until the step from the accepted state has no events.
/// Candidates are rounded as they will be stored *before* detection, so that the last round checks the path of exactly
/// the state to be accepted. [P3.2, Algorithm 1; mathematics.md, "The loop"]
class RoundLoop {
 public:
  /// Resumes the rounds toward this goal, if the time budget ended them.
  /// @param is_diverging if given, called for every sixth candidate while constraints accumulate; true ends the rounds
  RoundLoop(EditCall& call, const Controls& goal, Projection projection, PairLimit pair_limit, FirstSearch first,
            const StatePredicate& is_diverging);

  RoundOutcome run();

 private:
  bool candidate();
  bool search();
  bool constrain();
  void project();
  void shorten_step(int cuts);
  template <class Evaluate>
  auto at_feasible_candidate(const Evaluate& evaluate);

  std::optional<Events> find_events();
  void prune_cache();
  std::optional<Events> find_near_events();
  std::vector<ControlConstraint> linearised(std::vector<Stiv> stivs) const;
  void place_surface();

  EditCall& call_;
  const EditOptions& options_;
  FirstSearch first_;
  const StatePredicate& is_diverging_;
  RoundProgress& progress_;
  const Eigen::VectorXd* areas_ = nullptr;  // of the accepted surface, once there are events
  RoundOutcome outcome_;
};

/// Rounds toward a fraction of the way to the goal: twice the one given, or half, a quarter and so on of that, until
/// the step respects the pair limit. So time and memory are bounded for any motion. Updates `fraction`.
RoundOutcome run_rounds_within_reach(EditCall& call, const Controls& goal, Projection projection, FirstSearch first,
                                     double& fraction, const StatePredicate& is_diverging);

}  // namespace stiv
